// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/joint_state_joiner.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace prf_drivers {
namespace {

using prf_core::from_seconds;
using prf_core::Stamp;
using std::chrono::milliseconds;

constexpr Stamp kBegin = std::chrono::seconds(100);
constexpr std::size_t kArm = 0, kLegs = 1;

JointJoinerParams params(double period = 0.01) {
  JointJoinerParams result;
  result.sources = 2;
  result.period = period;
  result.settle = 0.02;
  result.max_age = 0.2;
  return result;
}

JointSample sample(Stamp since_begin, const std::string& joint, double position,
                   double velocity = 0.0) {
  return {kBegin + since_begin, {joint}, {position}, {velocity}, {0.0}};
}

int ticks_of(double source_hz, double tick_period, double seconds) {
  JointStateJoiner joiner(params(tick_period));
  int ticks = 0;
  for (int i = 0; i < static_cast<int>(seconds * source_hz); ++i) {
    if (joiner.add(kArm, sample(from_seconds(i / source_hz), "arm", 0.0)).tick) ++ticks;
  }
  return ticks;
}

TEST(JointStateJoiner, GivesATickForEachSampleOfALeadAsFastAsThePeriod) {
  EXPECT_EQ(ticks_of(100.0, 0.01, 10.0), 1000);
  EXPECT_EQ(ticks_of(40.0, 0.025, 10.0), 400);
  EXPECT_EQ(ticks_of(500.0, 0.002, 10.0), 5000);
}

TEST(JointStateJoiner, PicksTicksOnTheGridFromALeadThatIsFaster) {
  EXPECT_NEAR(ticks_of(500.0, 0.01, 10.0), 1000, 2);
  EXPECT_NEAR(ticks_of(125.0, 0.01, 10.0), 1000, 2);
  EXPECT_NEAR(ticks_of(1000.0, 0.025, 10.0), 400, 2);
}

TEST(JointStateJoiner, LosesNoTickToTheJitterOfStamps) {
  JointStateJoiner joiner(params());
  int ticks = 0;
  for (int i = 0; i < 500; ++i) {
    const Stamp jittered = milliseconds(10 * i + (i % 2 == 0 ? 2 : -2));
    if (joiner.add(kArm, sample(milliseconds(4) + jittered, "arm", 0.0)).tick) ++ticks;
  }
  EXPECT_EQ(ticks, 500);
}

TEST(JointStateJoiner, FillsInBetweenSamplesOfASlowLeadWithTheirVelocity) {
  JointStateJoiner joiner(params());
  ASSERT_TRUE(joiner.add(kArm, sample(milliseconds(0), "arm", 1.0, 0.5)).tick);
  const auto tick = joiner.tick_at(kBegin + milliseconds(40));
  ASSERT_TRUE(tick);
  EXPECT_EQ(tick->stamp, kBegin + milliseconds(40));
  EXPECT_NEAR(tick->positions[0], 1.02, 1e-12);
  EXPECT_FALSE(joiner.tick_at(kBegin + milliseconds(40))) << "twice";
}

// Fault 27: a slow driver's message comes after a tick was filled in that is ahead of it -> no tick
// goes back
TEST(JointStateJoiner, GivesNoTickBehindOneThatWasFilledIn) {
  JointStateJoiner joiner(params());
  ASSERT_TRUE(joiner.add(kArm, sample(milliseconds(0), "arm", 1.0, 0.5)).tick);
  ASSERT_TRUE(joiner.tick_at(kBegin + milliseconds(50)));
  EXPECT_FALSE(joiner.add(kArm, sample(milliseconds(48), "arm", 1.1, 0.5)).tick);
  EXPECT_FALSE(joiner.tick_at(kBegin + milliseconds(52))) << "half a period is the least";
  const auto next = joiner.tick_at(kBegin + milliseconds(60));
  ASSERT_TRUE(next);
  EXPECT_NEAR(next->positions[0], 1.1 + 0.5 * 0.012, 1e-12) << "of the newer message";
}

// Fault 27: the arm's joint states stop -> no ticks after max_age, so that the controller is silent
TEST(JointStateJoiner, DoesNotGuessBeyondTheAgeOfTheLead) {
  JointStateJoiner joiner(params());
  ASSERT_TRUE(joiner.add(kArm, sample(milliseconds(0), "arm", 1.0, 0.5)).tick);
  EXPECT_TRUE(joiner.tick_at(kBegin + milliseconds(200)));
  EXPECT_FALSE(joiner.tick_at(kBegin + milliseconds(201)));
}

TEST(JointStateJoiner, JoinsWhatIsSettledWhicheverComesFirst) {
  for (const bool legs_first : {true, false}) {
    JointStateJoiner joiner(params());
    std::optional<JointSample> last;
    for (int i = 0; i < 12; ++i) {
      const auto legs = [&] {
        if (i % 4 == 0) joiner.add(kLegs, sample(milliseconds(10 * i), "leg", i));
      };
      if (legs_first) legs();
      last = joiner.add(kArm, sample(milliseconds(10 * i), "arm", 0.0)).tick;
      if (!legs_first) legs();
    }
    ASSERT_TRUE(last);
    ASSERT_EQ(last->names, (std::vector<std::string>{"arm", "leg"}));
    EXPECT_EQ(last->positions[1], 8.0) << "of 80 ms, at the tick of 110 ms";
  }
}

// Fault 27: the legs' joint states stop -> left out of the ticks after max_age, the arm's go on
TEST(JointStateJoiner, LeavesOutASourceThatIsSilent) {
  JointStateJoiner joiner(params());
  joiner.add(kLegs, sample(milliseconds(0), "leg", 1.0));
  EXPECT_EQ(joiner.add(kArm, sample(milliseconds(200), "arm", 0.0)).tick->names.size(), 2U);
  EXPECT_EQ(joiner.add(kArm, sample(milliseconds(210), "arm", 0.0)).tick->names.size(), 1U);
}

TEST(JointStateJoiner, TakesAJointThatTwoNameFromTheFirst) {
  JointStateJoiner joiner(params());
  joiner.add(kLegs, sample(milliseconds(0), "arm", 7.0));
  const auto tick = joiner.add(kArm, sample(milliseconds(30), "arm", 1.0)).tick;
  EXPECT_EQ(tick->positions, std::vector<double>{1.0});
}

// Fault 1, 9, 42: joint states not finite, of other lengths, doubled or old -> dropped with the
// reason
TEST(JointStateJoiner, DropsWhatCannotBeUsed) {
  JointStateJoiner joiner(params());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  JointSample wrong = sample(milliseconds(0), "arm", nan);
  EXPECT_NE(joiner.add(kArm, wrong).refusal.find("\"arm\""), std::string::npos);
  wrong = sample(milliseconds(0), "arm", 0.0, 1e300);
  EXPECT_NE(joiner.add(kArm, wrong).refusal, "");
  wrong = sample(milliseconds(0), "arm", 0.0);
  wrong.positions.clear();
  EXPECT_NE(joiner.add(kArm, wrong).refusal, "");
  ASSERT_TRUE(joiner.add(kArm, sample(milliseconds(10), "arm", 0.0)).tick);
  EXPECT_EQ(joiner.add(kArm, sample(milliseconds(10), "arm", 0.0)).refusal,
            "its stamp came before");
  EXPECT_NE(joiner.add(kArm, sample(milliseconds(0), "arm", 0.0)).refusal, "");
  EXPECT_THROW(joiner.add(2, sample(milliseconds(20), "arm", 0.0)), std::invalid_argument);
}

// Fault 52: parameters beyond their bounds -> refused by name
TEST(JointStateJoiner, RefusesParametersBeyondTheirBounds) {
  for (const double period : {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(JointStateJoiner{params(period)}, std::invalid_argument);
  }
  JointJoinerParams none = params();
  none.sources = 0;
  EXPECT_THROW(JointStateJoiner{none}, std::invalid_argument);
}

}  // namespace
}  // namespace prf_drivers
