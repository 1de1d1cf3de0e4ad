// SPDX-License-Identifier: BSD-3-Clause
// Stamps that are wrong, and clocks that jump.
#include <string>

#include "joiner.hpp"

namespace prf_core {
namespace {

using std::chrono::milliseconds;

// Fault 40: a secondary late, doubled or early -> it is not used at any other tick, and none is
// lost
TEST(StreamJoiner, LosesNoPrimaryToASecondaryWithAWrongStamp) {
  for (const int wrong : {0, 4000, 4990, 5150, 5900, 6500, 1'000'000}) {
    Joiner joiner = joiner_with(milliseconds(300));
    primaries(joiner, {5000});
    secondaries(joiner, {5000, wrong});
    EXPECT_EQ(decided(joiner), "5000=5000 ");
    for (int ms = 5010; ms < 6000; ms += 10) {
      primary(joiner, ms);
      const std::string early = ms == wrong ? "" : decided(joiner);
      secondary(joiner, ms);
      const std::string joined = std::to_string(ms) + "=" + std::to_string(ms) + " ";
      ASSERT_EQ(early + decided(joiner), joined) << wrong;
    }
  }
}

// Fault 40: a secondary 60 ms early -> one primary at most goes without
TEST(StreamJoiner, LosesAtMostOnePrimaryToASecondaryThatIsALittleEarly) {
  Joiner joiner = joiner_with(milliseconds(300));
  primaries(joiner, {5000});
  secondaries(joiner, {5000, 5060});
  std::string text = decided(joiner);
  for (int ms = 5010; ms < 5050; ms += 10) {
    primary(joiner, ms);
    text += decided(joiner);
    secondary(joiner, ms);
    text += decided(joiner);
  }
  EXPECT_EQ(text, "5000=5000 5010=- 5020=5020 5030=5030 5040=5040 ");
}

TEST(StreamJoiner, TellsWhatItDoesWithASecondary) {
  Joiner joiner = joiner_with(milliseconds(300));
  EXPECT_EQ(secondary(joiner, 1'000'000), StampOrder::kNewer);  // there is no clock yet
  primary(joiner, 5000);
  EXPECT_EQ(secondary(joiner, 5000), StampOrder::kNewer);
  EXPECT_EQ(decided(joiner), "5000=5000 ");
  EXPECT_EQ(secondary(joiner, 5000), StampOrder::kDuplicate);
  EXPECT_EQ(secondary(joiner, 4990), StampOrder::kOld);
  EXPECT_EQ(secondary(joiner, 10), StampOrder::kOld);
  EXPECT_EQ(secondary(joiner, 6000), StampOrder::kNewer);
  EXPECT_EQ(secondary(joiner, 6001), StampOrder::kFarAhead);
}

// Fault 40: a primary late, from the past or far ahead -> dropped, the run goes on
TEST(StreamJoiner, DropsPrimariesOutOfOrder) {
  Joiner joiner = joiner_with(milliseconds(300));
  primaries(joiner, {5000, 4990, 10, 5010, 900'000, 5020});
  secondaries(joiner, {5000, 5010, 5020});
  EXPECT_EQ(decided(joiner), "5000=5000 5010=5010 5020=5020 ");
}

// Whichever stream shows the jump first; a secondary that is left of the old run is never joined.
// Fault 11: the clock jumps back -> a new run at the third tick, nothing old is joined to it
TEST(StreamJoiner, BeginsANewRunWhenThePrimariesGoBack) {
  for (const bool secondary_first : {true, false}) {
    Joiner joiner = joiner_with(milliseconds(300));
    primaries(joiner, {5000, 5010});
    secondaries(joiner, {5000, 5020});
    EXPECT_EQ(decided(joiner), "5000=5000 5010=- ");
    primaries(joiner, {0, 10});
    EXPECT_EQ(decided(joiner), "");
    EXPECT_TRUE(!secondary_first || secondary(joiner, 20) == StampOrder::kOld);
    EXPECT_EQ(primary(joiner, 20), StampOrder::kBackwardJump);
    if (!secondary_first) {
      EXPECT_EQ(decided(joiner), "");
      EXPECT_EQ(secondary(joiner, 5030), StampOrder::kFarAhead);
      EXPECT_EQ(secondary(joiner, 20), StampOrder::kNewer);
    }
    EXPECT_EQ(decided(joiner), "*20=20 ");
    for (int ms = 30; ms <= 5060; ms += 10) primary(joiner, ms);
    EXPECT_EQ(decided(joiner).find("=5"), std::string::npos);
  }
}

// Fault 13: the primaries leap forward -> joined again from the third one on
TEST(StreamJoiner, FollowsPrimariesThatLeapForward) {
  Joiner joiner = joiner_with(milliseconds(300));
  primaries(joiner, {0, 9000, 9010});
  secondaries(joiner, {0, 9020});
  EXPECT_EQ(decided(joiner), "0=0 ");
  EXPECT_EQ(primary(joiner, 9020), StampOrder::kForwardJump);
  EXPECT_EQ(decided(joiner), "9020=9020 ");
}

TEST(StreamJoiner, ForgetsASecondaryFarAheadOfTheFirstPrimary) {
  Joiner joiner = joiner_with(milliseconds(300));
  secondaries(joiner, {10, 1'000'000});
  primary(joiner, 10);
  EXPECT_EQ(decided(joiner), "10=10 ");
  primary(joiner, 20);
  EXPECT_EQ(decided(joiner), "");
}

// Fault 40, 51: a primary that names a stamp far ahead -> it alone goes without, the rest is joined
TEST(StreamJoiner, DoesNotWaitForAKeyFarAheadOfItsStamp) {
  Joiner joiner = joiner_with(Duration::max());
  joiner.push_primary(milliseconds(170), milliseconds(900'000), 170);
  EXPECT_EQ(decided(joiner), "170=- ");
  joiner.push_primary(milliseconds(180), milliseconds(100), 180);
  secondary(joiner, 100);
  EXPECT_EQ(decided(joiner), "180=100 ");
}

}  // namespace
}  // namespace prf_core
