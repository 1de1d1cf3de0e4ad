// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/input_health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace prf_ros {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Level = InputHealth::Level;

InputExpectation joints() { return {"joint_states", "JointState with joint_1", 100.0}; }

// Messages at `rate` Hz of wall time and of stamps; returns when the last one came.
double play(InputHealth& input, double begin, double seconds, double rate,
            const std::string& publisher = "/driver") {
  const int count = static_cast<int>(seconds * rate);
  for (int i = 0; i < count; ++i) {
    const double time = begin + i / rate;
    EXPECT_EQ(input.receive(publisher, 7.0 + time, time), "");
  }
  return begin + (count - 1) / rate;
}

TEST(InputHealth, HasNothingToSayOfAnInputThatIsAsExpected) {
  InputHealth input(joints(), 100.0);
  EXPECT_EQ(input.report(104.9).level, Level::kOk);
  const double end = play(input, 102.0, 10.0, 100.0);
  EXPECT_EQ(input.report(end + 4.9).level, Level::kOk);
  EXPECT_NEAR(*input.rate(), 100.0, 1e-6);
  EXPECT_EQ(input.received(), 1000u);
}

// Fault 46: an input that never comes, or no more -> after 5 s an error says what is expected
TEST(InputHealth, TellsSilence) {
  InputHealth input(joints(), 100.0);
  const auto never = input.report(105.0);
  EXPECT_EQ(never.level, Level::kError);
  EXPECT_TRUE(never.to_log);
  EXPECT_EQ(never.text,
            "no message on joint_states for 5 s, expected is JointState with joint_1 at 100 Hz");
  const double end = play(input, 105.0, 1.0, 100.0);
  const auto no_more = input.report(end + 6.0);
  EXPECT_EQ(no_more.level, Level::kError);
  EXPECT_THAT(no_more.text, HasSubstr("no message on joint_states any more for 6 s"));
}

TEST(InputHealth, AsksOfEachPresenceWhatItPromises) {
  InputExpectation expected = joints();
  expected.presence = Presence::kOnDemand;
  EXPECT_EQ(InputHealth(expected, 0.0).report(1000.0).level, Level::kOk);
  expected.presence = Presence::kOnce;
  InputHealth once(expected, 0.0);
  EXPECT_EQ(once.report(5.0).level, Level::kError);
  (void)once.receive("/driver", std::nullopt, 6.0);
  EXPECT_EQ(once.report(1000.0).level, Level::kOk);
}

// Fault 46: an input at a tenth of its rate -> a warning with both rates
TEST(InputHealth, TellsARateBelowHalfOfWhatIsExpectedByTheStamps) {
  InputHealth input(joints(), 0.0);
  const double end = play(input, 0.0, 5.0, 10.0);
  const auto slow = input.report(end);
  EXPECT_EQ(slow.level, Level::kWarn);
  EXPECT_THAT(slow.text, AllOf(HasSubstr("comes at 10 Hz"), HasSubstr("at 100 Hz")));
  EXPECT_EQ(input.report(play(input, end + 0.01, 2.0, 100.0)).level, Level::kOk);
}

TEST(InputHealth, TakesTheRateFromWhatIsNotDropped) {
  InputHealth input(joints(), 0.0);
  for (int i = 0; i < 200; ++i) {
    const double time = 0.01 * i;
    (void)input.receive("/driver", time, time);
    (void)input.receive("/driver", time - 0.5, time);
    (void)input.drop("old", time);
  }
  EXPECT_NEAR(*input.rate(), 100.0, 1e-6);
}

TEST(InputHealth, TakesTheRateFromTheStampsAndOneWrongStampForNothing) {
  InputHealth input(joints(), 0.0);
  for (int i = 0; i < 200; ++i) {  // a simulator at a twentieth of real time
    const double stamp = i % 10 == 5 ? 4e9 : 0.01 * i;
    (void)input.receive("/sim", stamp, 0.2 * i);
  }
  EXPECT_NEAR(*input.rate(), 100.0, 1e-6);
  EXPECT_EQ(input.report(40.0).level, Level::kOk);
}

// Fault 40: a second publisher of a topic -> a line names both; a successor is no second one
TEST(InputHealth, NamesASecondPublisher) {
  InputHealth input(joints(), 0.0);
  double end = play(input, 0.0, 1.0, 100.0);
  const std::string line = input.receive("/copy\n", 8.0, end + 0.005);
  EXPECT_THAT(line, AllOf(HasSubstr("\"/copy\\n\""), HasSubstr("\"/driver\"")));
  EXPECT_EQ(input.receive("/driver", 8.0, end + 0.01), "");  // said once in 5 s
  const auto report = input.report(end + 4.0);
  EXPECT_EQ(report.level, Level::kWarn);
  EXPECT_THAT(report.text, HasSubstr("has two publishers"));
  EXPECT_FALSE(report.to_log);

  InputHealth other(joints(), 0.0);
  end = play(other, 0.0, 1.0, 100.0);
  end = play(other, end + 1.5, 1.0, 100.0, "/driver_restarted");
  EXPECT_EQ(other.report(end).level, Level::kOk);
}

TEST(InputHealth, LetsATopicHaveManyPublishersThatMay) {
  InputExpectation expected{"/tf", "tf2_msgs/TFMessage"};
  expected.many_publishers = true;
  InputHealth input(expected, 0.0);
  EXPECT_EQ(input.receive("/a", std::nullopt, 0.0) + input.receive("/b", std::nullopt, 0.0), "");
  EXPECT_EQ(input.report(0.0).level, Level::kOk);
}

TEST(InputHealth, CountsDropsByReasonAndLogsEachOnceASecond) {
  InputHealth input(joints(), 0.0);
  std::vector<std::string> lines;
  for (int i = 0; i < 250; ++i) {
    const double now = 0.01 * i;
    (void)input.receive("/driver", now, now);
    const std::string line = i % 5 == 0 ? input.drop("joint_1 is missing", now) : "";
    if (!line.empty()) lines.push_back(line);
    const std::string other = i == 7 ? input.drop("not finite", now) : "not finite (1 so far)";
    EXPECT_THAT(other, HasSubstr("not finite (1 so far)"));
  }
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1],
            "joint_states dropped: joint_1 is missing (21 so far); expected is JointState with "
            "joint_1 at 100 Hz");
  EXPECT_EQ(input.drops(),
            (std::map<std::string, std::uint64_t>{{"joint_1 is missing", 50}, {"not finite", 1}}));
  EXPECT_EQ(input.report(2.5).level, Level::kWarn);
  EXPECT_EQ(input.report(2.5).text,
            "joint_states dropped: joint_1 is missing; joint_states dropped: not finite");
}

// Fault 46: an input whose every message is refused (wrong names) -> an error, as if silent
TEST(InputHealth, TakesAnInputThatIsAlwaysDroppedForAnError) {
  InputHealth input(joints(), 0.0);
  for (int i = 0; i < 600; ++i) {
    (void)input.receive("/driver", 0.01 * i, 0.01 * i);
    (void)input.drop("joint_1 is missing", 0.01 * i);
  }
  EXPECT_EQ(input.report(6.0).level, Level::kError);
  EXPECT_THAT(input.report(6.0).text, HasSubstr("every message on joint_states is dropped"));
  (void)input.receive("/driver", 6.0, 6.0);
  EXPECT_EQ(input.report(6.0).level, Level::kWarn);
  EXPECT_EQ(input.report(20.0).level, Level::kError);
}

TEST(InputHealth, RemembersABoundedNumberOfNamesAndReasons) {
  InputHealth input(joints(), 0.0);
  for (int i = 0; i < 1000; ++i) {
    (void)input.receive("/anonymous_" + std::to_string(i), 0.0, 0.01 * i);
    (void)input.drop("reason " + std::to_string(i), 0.01 * i);
  }
  EXPECT_LE(input.drops().size(), 21u);
}

}  // namespace
}  // namespace prf_ros
