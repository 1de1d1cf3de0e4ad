// SPDX-License-Identifier: BSD-3-Clause
// Where the arm is decides: no command of the controller is farther from the measured joints than
// its bound, whatever the joints, set-points and faults are.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "controller_test.hpp"

namespace prf_control {
namespace {

using jaco_kinematics::jaco_joint_limits;

constexpr double kRounding = 1e-9;

JointVector random_joints(std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  return JointVector::NullaryExpr(7, [&] { return uniform(random); });
}

double wrapped(double angle) { return std::remainder(angle, 2.0 * M_PI); }

bool is_continuous(int joint) { return std::isinf(jaco_joint_limits().upper[joint]); }

// `before` is the command of the tick before; none: the controller was started between them.
void expect_bounded(const std::optional<MotionState>& before, const ControlResult& result,
                    const JointSample& sample, double dt) {
  const JointVector fastest = 0.95 * jaco_joint_limits().velocity;
  ASSERT_TRUE(result.command);
  ASSERT_TRUE(result.command->position.allFinite() && result.command->velocity.allFinite());
  for (int i = 0; i < 7; ++i) {
    const double q = result.command->position[i];
    const double v = result.command->velocity[i];
    ASSERT_LE(std::abs(v), fastest[i] + kRounding);
    if (sample.position) {
      const double bound = result.restarted ? 0.0 : 0.2 + fastest[i] * dt;
      const double lag = q - (*sample.position)[i];
      ASSERT_LE(std::abs(is_continuous(i) ? lag : wrapped(lag)), bound + kRounding)
          << result.reason;
    }
    if (result.restarted) continue;
    ASSERT_TRUE(before);
    ASSERT_LE(std::abs(v - before->velocity[i]), 4.0 * dt + kRounding) << result.reason;
    ASSERT_NEAR(wrapped(q - before->position[i] - v * dt), 0.0, kRounding) << result.reason;
    if (is_continuous(i)) continue;
    const double low = std::min(jaco_joint_limits().lower[i], before->position[i]);
    const double high = std::max(jaco_joint_limits().upper[i], before->position[i]);
    ASSERT_GE(q, low);
    ASSERT_LE(q, high);
  }
}

// An arm that follows its commands in its own way, is thrown about, and counts turns anew (4). Its
// continuous joints turn as far as the command says, be it many turns.
struct WilfulArm {
  JointVector q;
  std::mt19937& random;

  void run(const MotionState& command, int mood) {
    if (mood == 0) q = random_joints(random, -7.0, 7.0);   // another arm, or another encoder
    if (mood == 1) q += random_joints(random, -0.4, 0.4);  // thrown
    if (mood == 4) q += 2.0 * M_PI * random_joints(random, -3.4, 3.4).array().round().matrix();
    if (mood <= 4) return;         // 2: blocked
    for (int i = 0; i < 7; ++i) {  // follows, with a lag
      const double way = command.position[i] - q[i];
      q[i] += 0.3 * (is_continuous(i) ? way : wrapped(way));
    }
  }
  JointSample sample(std::int64_t tick, int mood) const {
    if (mood == 3) return faulty_joints_at(tick);
    return joints_at(tick, q);
  }
};

Setpoint random_setpoint(std::mt19937& random, int mood) {
  if (mood == 5) return hold_setpoint();
  if (mood == 6) return refused_setpoint("bad");
  Eigen::Isometry3d pose = jaco_kinematics::forward(random_joints(random, 0.0, 6.2));
  if (mood == 7) pose.translation() *= 300.0;
  Setpoint setpoint = pose_setpoint(pose);
  if (mood == 8) setpoint.pose.angular_velocity.setConstant(900.0);
  return setpoint;
}

// Fault 37: joints in and out of limits, any set-point, NaN, respawns -> no command farther
// from the arm than its bound
TEST(CommandBounds, HoldWhateverComes) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> moods(0, 400);
  auto controller = std::make_unique<ArmController>(jaco(), controller_params());
  WilfulArm arm{home(), random};
  Setpoint setpoint = hold_setpoint();
  std::optional<MotionState> before;
  int restarts = 0;
  int followed = 0;
  int since = 0;  // ticks from the command before
  std::int64_t stamp = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    const int mood = moods(random);
    const int pause = mood == 9 ? 50 : mood == 10 ? 7 : 1;
    stamp += pause;
    since += pause;
    if (mood == 11) {  // killed and respawned
      controller = std::make_unique<ArmController>(jaco(), controller_params());
      before.reset();
    }
    if (mood >= 5 && mood <= 8) setpoint = random_setpoint(random, mood);
    if (mood >= 12 && mood <= 15) setpoint = random_setpoint(random, 9);
    const JointSample sample = arm.sample(stamp, mood);
    const auto results = answers(*controller, sample, setpoint);
    if (results.empty()) {
      ASSERT_GT(pause, 1) << "only a tick after a gap waits for one that confirms it";
      continue;
    }
    const ControlResult& result = results.front();
    if (!before && !sample.position) continue;
    ASSERT_NO_FATAL_FAILURE(expect_bounded(before, result, sample, 0.01 * std::min(since, 30)))
        << "tick " << tick << " mood " << mood;
    before = result.command;
    since = 0;
    restarts += result.restarted;
    followed += result.code == ControlCode::kFollowing || result.code == ControlCode::kLimited;
    arm.run(*result.command, mood);
    ASSERT_EQ(controller->counts().refused_commands, 0u) << "the gate is the last resort";
  }
  EXPECT_GT(restarts, 150);
  EXPECT_GT(followed, 3000);
}

// Fault 37: joint 4 reported as -1.0 with a set-point that means hold -> the command stays
// there, in the turn of the limits
TEST(CommandBounds, HoldAnArmThatReportsAnotherTurn) {
  ArmController controller(jaco(), controller_params());
  JointVector q = home();
  q[3] = -1.0;
  for (int tick = 0; tick < 100; ++tick) {
    const ControlResult result = ask(controller, joints_at(tick, q), hold_setpoint());
    EXPECT_EQ(result.code, ControlCode::kHolding);
    EXPECT_NEAR(result.command->position[3], 5.2831853, 1e-7);
    EXPECT_EQ(result.restarted, tick == 0);
    if (tick == 0) {
      EXPECT_NE(result.reason.find("joint_4 is reported as -1 rad"), std::string::npos)
          << result.reason;
    }
  }
}

// Fault 37: joint 2 at 0.70, limit 0.82 -> holds there; to follow it first goes back inside,
// slowly, and says so
TEST(CommandBounds, BringAnArmOutsideItsLimitsBackSlowly) {
  const double lower = jaco_joint_limits().lower[1];
  ArmController controller(jaco(), controller_params());
  JointVector q = home();
  q[1] = 0.70;
  for (int tick = 0; tick < 50; ++tick) {
    const ControlResult result = ask(controller, joints_at(tick, q), hold_setpoint());
    EXPECT_EQ(result.command->position, q);
    EXPECT_NE(result.reason.find("joint_2 at 0.7 rad is outside its limits"), std::string::npos);
  }
  int inside = 0;
  for (int tick = 50; tick < 1500; ++tick) {
    const auto before = q;
    const ControlResult result = ask(controller, joints_at(tick, q), beside_home(0.0));
    q = result.command->position;
    if (before[1] >= lower - kRounding) {
      ++inside;
      continue;
    }
    ASSERT_EQ(result.code, ControlCode::kLimited);
    ASSERT_NE(result.reason.find("back inside"), std::string::npos) << result.reason;
    ASSERT_GE(q[1], before[1]);
    ASSERT_LE((q - before).cwiseAbs().maxCoeff(), 0.25 * 0.95 * 0.6284 * kDt);
  }
  EXPECT_GT(inside, 1300);
  EXPECT_LE(ask(controller, joints_at(1500, q), beside_home(0.0)).deviation, 1e-6);
}

// Fault 37: joint 2 half a radian outside its limits -> no arm can be there: it is not moved,
// FAILING
TEST(CommandBounds, RefuseToMoveAnArmFarOutsideItsLimits) {
  ArmController controller(jaco(), controller_params());
  JointVector q = home();
  q[1] = jaco_joint_limits().upper[1] + 0.5;
  for (int tick = 0; tick < 50; ++tick) {
    const ControlResult result = ask(controller, joints_at(tick, q), beside_home(0.05));
    EXPECT_EQ(result.code, ControlCode::kFailing);
    EXPECT_NE(result.reason.find("is not moved"), std::string::npos) << result.reason;
    EXPECT_EQ(result.command->position, q);
    EXPECT_GT(result.position_error, 0.05);
  }
  EXPECT_EQ(controller.counts().faulty_joints, 50u);
}

}  // namespace
}  // namespace prf_control
