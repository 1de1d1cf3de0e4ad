// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/arm_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "controller_test.hpp"

namespace prf_control {
namespace {

TEST(ArmController, StartsFromTheMeasuredJointsAtRest) {
  ArmController controller(jaco(), controller_params());
  const ControlResult result = ask(controller, joints_at(1), beside_home(0.3));
  EXPECT_EQ(result.stamp, kTick);
  EXPECT_TRUE(result.restarted);
  EXPECT_EQ(result.code, ControlCode::kHolding);
  EXPECT_EQ(result.command->position, home());
  EXPECT_EQ(result.command->velocity, JointVector::Zero(7));
}

TEST(ArmController, SaysNothingBeforeItKnowsTheJoints) {
  ArmController controller(jaco(), controller_params());
  EXPECT_TRUE(controller.add_setpoint(kTick, beside_home(0.0)).empty());
  const auto results = controller.add_joints(faulty_joints_at(1));
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results.front().code, ControlCode::kFailing);
  EXPECT_FALSE(results.front().command);
  EXPECT_TRUE(std::isnan(results.front().position_error));
  EXPECT_EQ(ask(controller, joints_at(2), beside_home(0.0)).command->position, home());
}

TEST(ArmController, FollowsAndReportsErrorAndDeviation) {
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(0), hold_setpoint());
  const ControlResult result = ask(controller, joints_at(1), beside_home(0.05));
  EXPECT_EQ(result.code, ControlCode::kFollowing);
  EXPECT_TRUE(result.reason.empty());
  EXPECT_NEAR(result.position_error, 0.05, 1e-12);
  EXPECT_NEAR(result.orientation_error, 0.0, 1e-12);
  EXPECT_LT(result.deviation, 0.05);
  EXPECT_GT(result.deviation, 0.049);
}

TEST(ArmController, NamesTheJointThatSlowsItDown) {
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(0), hold_setpoint());
  ControlResult result;
  JointVector measured = home();
  for (int i = 1; i < 40; ++i) {
    result = ask(controller, joints_at(i, measured), beside_home(-0.4));
    measured = result.command->position;
  }
  EXPECT_EQ(result.code, ControlCode::kLimited);
  EXPECT_NE(result.reason.find("joint_"), std::string::npos);
  EXPECT_NE(result.reason.find("bound 0.79587 rad/s"), std::string::npos) << result.reason;
}

// Fault 24: a set-point out of reach -> the nearest pose, UNREACHABLE with the deviation
TEST(ArmController, ReportsASetpointOutOfReach) {
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(0), hold_setpoint());
  const ControlResult result = ask(controller, joints_at(1), beside_home(2.0));
  EXPECT_EQ(result.code, ControlCode::kUnreachable);
  EXPECT_FALSE(result.reason.empty());
  EXPECT_NEAR(result.deviation, 2.0, 0.01);
}

// Fault 1, 39: joints or set-point that cannot be used -> holds, says why, and reports the
// following error all the same
TEST(ArmController, HoldsOnHoldOnARefusedSetpointAndOnFaultyJoints) {
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(0), hold_setpoint());
  EXPECT_EQ(ask(controller, joints_at(1), hold_setpoint()).code, ControlCode::kHolding);

  const ControlResult refused = ask(controller, joints_at(2), refused_setpoint("wrong frame"));
  EXPECT_EQ(refused.code, ControlCode::kInvalidSetpoint);
  EXPECT_EQ(refused.reason, "wrong frame");
  EXPECT_EQ(refused.command->position, home());

  const ControlResult faulty = ask(controller, faulty_joints_at(3), beside_home(0.05));
  EXPECT_EQ(faulty.code, ControlCode::kFailing);
  EXPECT_NEAR(faulty.position_error, 0.05, 1e-12) << "of the last known hand";
  EXPECT_EQ(faulty.reason, "joint_3 bad");
  EXPECT_EQ(faulty.command->position, home());
}

// Fault 26, 27: set-points stop for a second, as when the decision is respawned -> holds within the
// timeout, resumes without a jump
TEST(ArmController, HoldsWhenSetpointsStopAndResumesWithoutAJump) {
  ArmController controller(jaco(), controller_params());
  std::vector<ControlResult> results;
  JointVector measured = home();
  const auto add = [&](const std::vector<ControlResult>& more) {
    for (const ControlResult& result : more) {
      results.push_back(result);
      measured = result.command->position;
    }
  };
  for (int i = 0; i < 300; ++i) {
    add(controller.add_joints(joints_at(i, measured)));
    const bool silent = i >= 100 && i < 200;
    if (!silent) add(controller.add_setpoint(i * kTick, beside_home(0.1)));
  }
  ASSERT_EQ(results.size(), 300u);
  for (std::size_t i = 1; i < results.size(); ++i) {
    EXPECT_EQ(results[i].stamp, static_cast<int>(i) * kTick);
    const bool stale = results[i].code == ControlCode::kStaleSetpoint;
    EXPECT_EQ(stale, i >= 100 && i <= 200) << i;  // tick 200 came before its set-point
    const JointVector step = results[i].command->position - results[i - 1].command->position;
    EXPECT_LE(step.cwiseAbs().maxCoeff(), 0.0085);
    const bool at_rest = step == JointVector::Zero(7);
    EXPECT_TRUE(at_rest || i < 130 || i >= 200) << i;
  }
  EXPECT_LE(results.back().deviation, 1e-6);
}

// Fault 39: the arm is moved by force -> the command begins anew where the arm is, and the joint is
// named
TEST(ArmController, StartsAnewWhereTheJointsWereMovedByForce) {
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(0), hold_setpoint());
  JointVector moved = home();
  moved[3] += 0.25;
  const ControlResult result = ask(controller, joints_at(1, moved), beside_home(0.0));
  EXPECT_TRUE(result.restarted);
  EXPECT_NE(result.reason.find("joint_4"), std::string::npos);
  EXPECT_EQ(result.command->position, moved);
  EXPECT_GT(result.position_error, 0.05) << "from the set-point, not from the new command";
  moved[3] += 0.25;
  EXPECT_GT(ask(controller, joints_at(2, moved), hold_setpoint()).position_error, 0.05)
      << "from where it should have held";
}

// Fault 37: a driver begins another count of a continuous joint's turns -> the commands follow, the
// joint does not turn
TEST(ArmController, FollowsAContinuousJointIntoAnotherTurn) {
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(0), hold_setpoint());
  const MotionState before = *ask(controller, joints_at(1), beside_home(0.05)).command;
  JointVector turns = JointVector::Zero(7);
  turns[0] = 2.0 * M_PI;
  turns[6] = -6.0 * M_PI;
  const ControlResult result =
      ask(controller, joints_at(2, before.position + turns), beside_home(0.05));
  EXPECT_FALSE(result.restarted);
  EXPECT_EQ(result.code, ControlCode::kFollowing) << result.reason;
  EXPECT_EQ(controller.counts().other_turns, 1u);
  const MotionState moved{before.position + turns, before.velocity};
  expect_within_limits(moved, *result.command, kDt);
}

// Fault 11, 13: the clock goes back or leaps, confirmed by three ticks -> the command begins anew
// at the joints
TEST(ArmController, StartsAnewAfterALeapAndWhenTimeGoesBack) {
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(100), hold_setpoint());
  EXPECT_FALSE(ask(controller, joints_at(101), beside_home(0.02)).restarted);
  for (const int tick : {498, 499}) controller.add_joints(joints_at(tick));
  EXPECT_TRUE(ask(controller, joints_at(500), beside_home(0.02)).restarted);
  for (const int tick : {1, 2}) controller.add_joints(joints_at(tick));
  const ControlResult first = ask(controller, joints_at(3), beside_home(0.02));
  EXPECT_TRUE(first.restarted);
  EXPECT_EQ(first.command->position, home());
  EXPECT_EQ(controller.counts().restarts, 3u);
  EXPECT_EQ(controller.joiner_counts().new_runs, 1u);
}

// A random run: far jumps, holds, refusals, faulty joints, missing set-points.
std::vector<ControlResult> random_run(unsigned seed) {
  std::mt19937 data(7);
  std::mt19937 order(seed);
  std::uniform_real_distribution<double> offset(-0.4, 0.4);
  ArmController controller(jaco(), controller_params());
  std::vector<ControlResult> results;
  std::vector<std::pair<int, Setpoint>> setpoints;
  std::vector<JointSample> samples;
  Setpoint current = beside_home(0.0);
  for (int i = 0; i < 400; ++i) {
    if (i % 40 == 0) current = beside_home(offset(data));
    if (i % 90 == 89) current = hold_setpoint();
    if (i % 130 == 129) current = refused_setpoint("bad");
    samples.push_back(i % 50 == 49 ? faulty_joints_at(i) : joints_at(i));
    if (i % 17 != 0 || i == 0) setpoints.emplace_back(i, current);
  }
  std::size_t next_sample = 0;
  std::size_t next_setpoint = 0;
  while (next_sample < samples.size() || next_setpoint < setpoints.size()) {
    const int tick_time = next_sample < samples.size() ? static_cast<int>(next_sample) : 1000;
    const int setpoint_time =
        next_setpoint < setpoints.size() ? setpoints[next_setpoint].first : 1000;
    const int lead = tick_time - setpoint_time;
    const bool tick_next = lead < -20 || (lead < 20 && order() % 2 == 0);
    const auto more = tick_next ? controller.add_joints(samples[next_sample++])
                                : controller.add_setpoint(setpoint_time * kTick,
                                                          setpoints[next_setpoint++].second);
    results.insert(results.end(), more.begin(), more.end());
  }
  return results;
}

TEST(ArmController, GivesTheSameBitsWhateverTheInterleaving) {
  const auto first = random_run(0);
  ASSERT_EQ(first.size(), 400u);
  for (unsigned seed = 1; seed < 20; ++seed) {
    const auto other = random_run(seed);
    ASSERT_EQ(other.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_EQ(other[i].stamp, first[i].stamp);
      ASSERT_EQ(other[i].code, first[i].code) << i;
      ASSERT_EQ(other[i].reason, first[i].reason);
      ASSERT_EQ(other[i].command->position, first[i].command->position) << i;
      ASSERT_EQ(other[i].command->velocity, first[i].command->velocity);
      ASSERT_EQ(other[i].deviation, first[i].deviation);
      ASSERT_EQ(other[i].position_error, first[i].position_error);
    }
  }
}

// Joints that follow v + gain (q_command - q) through a first-order lag, as a servo drive does.
struct Servo {
  JointVector position;
  JointVector velocity = JointVector::Zero(7);

  void run(const MotionState& command) {
    constexpr double kGain = 20.0;  // 1/s
    constexpr double kLag = 0.01;   // s
    constexpr int kSteps = 10;
    for (int i = 0; i < kSteps; ++i) {
      const double h = kDt / kSteps;
      const JointVector wanted = command.velocity + kGain * (command.position - position);
      velocity += (wanted - velocity) * (1.0 - std::exp(-h / kLag));
      position += h * velocity;
    }
  }
};

// The error of the hand, set-point to plant at the same tick, over four periods of sway.
double sway_error(double amplitude, double frequency, bool feed_forward) {
  ArmController controller(jaco(), controller_params());
  Servo servo{home()};
  double worst = 0.0;
  const int ticks = static_cast<int>(5.0 * 2.0 * M_PI / frequency / kDt);
  for (int i = 0; i < ticks; ++i) {
    const double phase = frequency * kDt * i;
    Setpoint setpoint = beside_home(amplitude * std::sin(phase));
    if (feed_forward) {
      setpoint.pose.linear_velocity.y() = amplitude * frequency * std::cos(phase);
    }
    const ControlResult result = ask(controller, joints_at(i, servo.position), setpoint);
    if (i > ticks / 5) worst = std::max(worst, result.position_error);
    servo.run(*result.command);
  }
  return worst;
}

TEST(ArmController, FollowsTheSwayOfThePlatformThroughAServo) {
  const double heavy = sway_error(0.05, 2.4, true);
  const double without = sway_error(0.05, 2.4, false);
  std::cout << "worst error of the hand, sway 0.05 m at 2.4 rad/s: " << 1e3 * heavy
            << " mm with velocity feed-forward, " << 1e3 * without << " mm without\n";
  EXPECT_LE(heavy, 2e-3);
  EXPECT_GT(without, heavy);
}

TEST(ArmController, GoesSlowerFromTheTickThatIsAnnounced) {
  ArmController controller(jaco(), controller_params());
  controller.scale_speed(100 * kTick, 0.2);
  double before = 0, after = 0;
  JointVector measured = home();
  for (int tick = 0; tick < 200; ++tick) {
    const auto result = ask(controller, joints_at(tick, measured), beside_home(0.3));
    measured = result.command->position;
    const double speed =
        result.command->velocity.cwiseQuotient(jaco_kinematics::jaco_joint_limits().velocity)
            .cwiseAbs()
            .maxCoeff();
    if (tick < 100) before = std::max(before, speed);
    if (tick > 120) after = std::max(after, speed);  // braking takes its time
  }
  EXPECT_GT(before, 0.5);
  EXPECT_LT(after, 0.2);
  EXPECT_THROW(controller.scale_speed(prf_core::Stamp(0), 1.1), std::invalid_argument);
}

}  // namespace
}  // namespace prf_control
