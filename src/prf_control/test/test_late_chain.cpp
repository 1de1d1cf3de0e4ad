// SPDX-License-Identifier: BSD-3-Clause
// What the arm does when ticks or set-points come late, when the controller is respawned, and when
// it is tuned in full motion.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "controller_test.hpp"

namespace prf_control {
namespace {

using Results = std::vector<ControlResult>;

void append(Results& results, const Results& more) {
  results.insert(results.end(), more.begin(), more.end());
}

// Set-points that arrive so many ticks after their own, while the arm follows at once.
Results run_with_late_setpoints(int late, int ticks) {
  ArmController controller(jaco(), controller_params());
  Results results;
  JointVector measured = home();
  for (int i = 0; i < ticks + late; ++i) {
    Results more;
    if (i < ticks) append(more, controller.add_joints(joints_at(i, measured)));
    if (i >= late) append(more, controller.add_setpoint((i - late) * kTick, beside_home(0.1)));
    if (!more.empty()) measured = more.back().command->position;
    append(results, more);
  }
  return results;
}

double largest_step(const Results& results) {
  double largest = 0.0;
  for (std::size_t i = 1; i < results.size(); ++i) {
    const JointVector step = results[i].command->position - results[i - 1].command->position;
    largest = std::max(largest, step.cwiseAbs().maxCoeff());
  }
  return largest;
}

// Fault 50: set-points late by less than max_wait -> the ticks wait, every set-point is
// followed, nothing is held
TEST(LateChain, WaitsForSetpointsWithinMaxWait) {
  for (const int late : {0, 6, 28}) {
    const Results results = run_with_late_setpoints(late, 200);
    ASSERT_EQ(results.size(), 200u);
    for (std::size_t i = 1; i < results.size(); ++i) {
      ASSERT_EQ(results[i].stamp, static_cast<int>(i) * kTick);
      ASSERT_NE(results[i].code, ControlCode::kStaleSetpoint) << late;
    }
    EXPECT_LE(largest_step(results), 0.0085);
  }
}

// Fault 50: set-points later than max_wait -> the arm brakes and holds, STALE; late ones are
// dropped and counted
TEST(LateChain, HoldsWhileSetpointsAreLaterThanMaxWait) {
  ArmController controller(jaco(), controller_params());
  Results results;
  for (int i = 0; i < 200; ++i) {
    append(results, controller.add_joints(joints_at(i)));
    if (i >= 40) append(results, controller.add_setpoint((i - 40) * kTick, beside_home(0.1)));
  }
  ASSERT_GT(results.size(), 150u);
  for (const ControlResult& result : results) {
    if (result.restarted) continue;
    ASSERT_EQ(result.code, ControlCode::kStaleSetpoint);
    ASSERT_EQ(result.command->position, home());
  }
  EXPECT_GT(controller.joiner_counts().late_setpoints, 100u);
}

// Fault 50: ticks 60 to 290 ms apart -> one step of that length within all limits; farther
// apart -> anew from the joints
TEST(LateChain, TakesLateTicksAsOneLongStep) {
  for (const int gap : {6, 29}) {
    ArmController controller(jaco(), controller_params());
    (void)ask(controller, joints_at(0), hold_setpoint());
    MotionState last{home(), JointVector::Zero(7)};
    for (int i = 1; i < 20; ++i) {
      const auto result = ask(controller, joints_at(i * gap, last.position), beside_home(0.3));
      ASSERT_FALSE(result.restarted);
      ASSERT_NO_FATAL_FAILURE(expect_within_limits(last, *result.command, gap * kDt));
      last = *result.command;
    }
  }
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(0), hold_setpoint());
  (void)ask(controller, joints_at(1), beside_home(0.3));
  JointVector moved = home();
  moved[2] += 0.01;
  const ControlResult result = ask(controller, joints_at(32, moved), beside_home(0.3));
  EXPECT_TRUE(result.restarted);
  EXPECT_NE(result.reason.find("jumped forward by 0.31 s, bound 0.3 s"), std::string::npos);
  EXPECT_EQ(result.command->position, moved);
}

// Fault 39, 50: ticks of an arm that stood still come in a burst -> no command beyond the
// bound from where it stands
TEST(LateChain, DoesNotRunAwayFromAnArmThatDoesNotMove) {
  ArmController controller(jaco(), controller_params());
  (void)ask(controller, joints_at(0), hold_setpoint());
  for (int i = 1; i < 500; ++i) {
    const ControlResult result = ask(controller, joints_at(i), beside_home(-0.4));
    const double lag = (result.command->position - home()).cwiseAbs().maxCoeff();
    ASSERT_LE(lag, 0.2 + 0.0080);
    ASSERT_NEAR(result.position_error, 0.4, 1e-9)
        << "the following error says that it does not move";
  }
  EXPECT_GT(controller.counts().restarts, 5u);
}

// Fault 40: one tick or set-point late, far ahead or doubled -> dropped and counted, the run
// goes on bit by bit
TEST(OddMessages, CostNothingButThemselves) {
  Results expected;
  std::uint64_t expected_restarts = 0;
  for (const bool odd : {false, true}) {
    ArmController controller(jaco(), controller_params());
    Results results;
    for (int i = 1000; i < 1200; ++i) {
      append(results, controller.add_joints(joints_at(i)));
      if (odd && i % 20 == 0) {
        for (const int away : {0, -1, -100, -500, 100000}) {
          append(results, controller.add_joints(joints_at(i + away, JointVector::Ones(7))));
          if (away != 0)
            append(results, controller.add_setpoint((i + away) * kTick, hold_setpoint()));
        }
      }
      append(results, controller.add_setpoint(i * kTick, beside_home(0.02)));
      if (odd) append(results, controller.add_setpoint(i * kTick, hold_setpoint()));
    }
    if (!odd) {
      expected = results;
      expected_restarts = controller.counts().restarts;
    }
    ASSERT_EQ(results.size(), 200u);
    for (std::size_t i = 0; i < results.size(); ++i) {
      ASSERT_EQ(results[i].stamp, expected[i].stamp);
      ASSERT_EQ(results[i].code, expected[i].code) << i;
      ASSERT_EQ(results[i].command->position, expected[i].command->position) << i;
    }
    if (!odd) continue;
    EXPECT_EQ(controller.counts().restarts, expected_restarts);
    EXPECT_EQ(controller.joiner_counts().new_runs, 0u);
    EXPECT_EQ(controller.joiner_counts().duplicate_ticks, 10u);
    EXPECT_EQ(controller.joiner_counts().old_ticks, 30u);
    EXPECT_EQ(controller.joiner_counts().far_ahead_ticks, 10u);
    EXPECT_GE(controller.joiner_counts().late_setpoints, 200u);
  }
}

// Fault 26: the controller is killed in motion and respawned -> begins where the joints are, at
// rest, within all limits
TEST(Respawn, GoesOnFromTheMeasuredJointsWithoutAJump) {
  JointVector measured = home();
  MotionState last = at_rest(JointVector::Zero(7));
  for (int life = 0; life < 5; ++life) {
    ArmController controller(jaco(), controller_params());
    for (int i = 0; i < 37; ++i) {
      const auto result =
          ask(controller, joints_at(100 * life + i, measured), beside_home(life % 2 ? -0.4 : 0.4));
      ASSERT_EQ(result.restarted, i == 0);
      if (i == 0) {
        EXPECT_EQ(result.command->position, measured);
        EXPECT_EQ(result.command->velocity, JointVector::Zero(7));
      } else {
        ASSERT_NO_FATAL_FAILURE(expect_within_limits(last, *result.command, kDt));
      }
      last = *result.command;
      measured += 0.5 * (last.position - measured);  // a servo that lags behind
    }
    EXPECT_GT(last.velocity.norm(), 0.1) << "killed in motion";
  }
}

// Fault 29, 52: tuned in full motion -> refused whole, or applied, and the arm stops as soon as it
// would have before
TEST(LiveTuning, LeavesAMotionAsStoppableAsItWas) {
  ArmController controller(jaco(), controller_params());
  ControlResult result = ask(controller, joints_at(0), hold_setpoint());
  int tick = 1;
  for (; tick < 60; ++tick) {
    result = ask(controller, joints_at(tick, result.command->position), beside_home(-0.6));
  }
  for (const double bad : {0.001, 5e-324, 1e308, std::nan("")}) {
    EXPECT_THROW(controller.tune(0.95, bad), std::invalid_argument);
    EXPECT_THROW(controller.tune(bad, 4.0), std::invalid_argument);
  }
  controller.tune(0.95, 0.1);
  const double fastest = result.command->velocity.cwiseAbs().maxCoeff();
  EXPECT_GT(fastest, 0.5);
  const int stop = tick + static_cast<int>(fastest / 4.0 / kDt) + 1;
  for (; tick < stop; ++tick) {
    result = ask(controller, joints_at(tick, result.command->position), hold_setpoint());
  }
  EXPECT_LE(result.command->velocity.norm(), 1e-12);
  const MotionState before = *result.command;
  result = ask(controller, joints_at(tick, before.position), beside_home(0.3));
  EXPECT_LE(result.command->velocity.cwiseAbs().maxCoeff(), 0.1 * kDt + 1e-12) << "0.1 to speed up";
}

}  // namespace
}  // namespace prf_control
