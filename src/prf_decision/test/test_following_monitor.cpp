// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/following_monitor.hpp"

#include <gtest/gtest.h>

#include "scenario.hpp"

namespace prf_decision {
namespace {

const FollowingParams kParams = usual_guards().following;

FollowingInput input_at(double seconds, double error) {
  FollowingInput input;
  input.stamp = from_seconds(seconds);
  input.setpoint = pose_at(0.5, 0, 0.5);
  input.hand = pose_at(0.5, error, 0.5);
  input.report = ControlReport{input.stamp - from_seconds(0.05), false, ""};
  return input;
}

TEST(FollowingMonitor, MeasuresTheHandAgainstTheSetPoint) {
  FollowingMonitor monitor;
  FollowingInput input = input_at(1, 0.04);
  input.hand->orientation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  monitor.update(kParams, input);
  EXPECT_NEAR(monitor.error()->position, 0.04, 1e-12);
  EXPECT_NEAR(monitor.error()->rotation, 0.1, 1e-9);
  EXPECT_TRUE(monitor.is_on_goal());
  monitor.update(kParams, input_at(1.01, 0.06));
  EXPECT_FALSE(monitor.is_on_goal());
  EXPECT_FALSE(monitor.is_off());
  input.setpoint.reset();
  monitor.update(kParams, input);
  EXPECT_FALSE(monitor.error());
  EXPECT_FALSE(monitor.is_on_goal());
}

// Fault 39: hand thrown to and fro across the bound -> it does not follow until it stays within
TEST(FollowingMonitor, CountsAHandThatComesAndGoesAsOff) {
  FollowingMonitor monitor;
  for (int tick = 0; tick < 100; ++tick) {
    monitor.update(kParams, input_at(0.01 * tick, tick % 10 < 5 ? 0.2 : 0.0));
    EXPECT_EQ(monitor.lasting(from_seconds(0.01 * tick)), from_seconds(0.01 * tick));
  }
  EXPECT_EQ(monitor.trouble().rfind("hand 0.20 m and 0.00 rad from its set-point", 0), 0u);
  for (int tick = 100; tick < 120; ++tick) monitor.update(kParams, input_at(0.01 * tick, 0));
  EXPECT_FALSE(monitor.is_off());
  EXPECT_EQ(monitor.trouble(), "");
}

// Fault 39: hand off its set-point again and again -> the time adds up, a quarter is forgiven
TEST(FollowingMonitor, AddsUpForHowLongTheArmIsOffWhileItIsMoved) {
  FollowingMonitor monitor;
  FollowingInput input = input_at(0, 0);
  const auto off_in_all_after = [&](int ticks, double error) {
    for (int i = 0; i < ticks; ++i) {
      const Stamp next = input.stamp + kTickPeriod;
      const bool is_moved = input.is_moved;
      input = input_at(0, error);
      input.stamp = next;
      input.report->stamp = next;
      input.is_moved = is_moved;
      monitor.update(kParams, input);
    }
    return to_seconds(monitor.off_in_all());
  };
  EXPECT_EQ(off_in_all_after(100, 0), 0);
  EXPECT_NEAR(off_in_all_after(40, 0.2), 0.40, 1e-9);
  // Ten ticks later it has followed again; from there on a quarter of the time is forgiven.
  EXPECT_NEAR(off_in_all_after(50, 0), 0.40 + 0.10 - 0.10, 1e-9);
  EXPECT_NEAR(off_in_all_after(30, 0.2), 0.70, 1e-9);
  EXPECT_EQ(off_in_all_after(1000, 0), 0);
  input.is_moved = false;
  EXPECT_EQ(off_in_all_after(1000, 0.2), 0) << "an arm that is not moved need not follow";
}

TEST(FollowingMonitor, IsOffWhileTheRotationIsAndWhenAnErrorIsNotANumber) {
  FollowingInput turned = input_at(1, 0);
  turned.hand->orientation = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX());
  for (const FollowingInput& input : {turned, input_at(1, NAN)}) {
    FollowingMonitor monitor;
    monitor.update(kParams, input);
    EXPECT_TRUE(monitor.is_off());
    EXPECT_FALSE(monitor.is_on_goal());
  }
}

// Fault 38: controller silent, failing, or joints unknown -> the arm is off whatever the error
// is
TEST(FollowingMonitor, IsOffWhenTheControllerOrTheHandIsNotToBeTrusted) {
  FollowingInput silent = input_at(1, 0);
  silent.controller_silent = true;
  FollowingInput failing = input_at(1, 0);
  failing.report->failing = true;
  failing.report->reason = "joint 2 unknown";
  FollowingInput unknown = input_at(1, 0);
  unknown.hand.reset();
  for (const auto& [input, reason] :
       {std::pair(silent, "control/status silent for 0.05 s"),
        std::pair(failing, "the arm controller does not follow: joint 2 unknown"),
        std::pair(unknown, "the measured hand is unknown")}) {
    FollowingMonitor monitor;
    monitor.update(kParams, input);
    EXPECT_TRUE(monitor.is_off());
    EXPECT_FALSE(monitor.is_on_goal());
    EXPECT_EQ(monitor.trouble(), reason);
  }
}

}  // namespace
}  // namespace prf_decision
