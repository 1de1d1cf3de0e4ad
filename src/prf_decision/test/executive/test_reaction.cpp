// SPDX-License-Identifier: BSD-3-Clause
// The reaction is monotone: for each state, more speed, more spread, more time since the last
// measurement or less reach never gives a bolder state, at no tick; and no danger keeps the hand at
// the target for long.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <vector>

#include "executive_world.hpp"

namespace prf_decision {
namespace {

// 2 stays or goes there, 1 stands, 0 goes away.
int boldness_of(const Progress& progress) {
  switch (progress.state) {
    case ExecutionState::kForward:
    case ExecutionState::kTracking:
    case ExecutionState::kDone:
      return 2;
    case ExecutionState::kPause:
      return 1;
    case ExecutionState::kWaiting:
    case ExecutionState::kStopped:
      return progress.cursor > 0 ? 1 : 0;
    case ExecutionState::kReverse:
    case ExecutionState::kRetract:
    case ExecutionState::kSearch:
      break;
  }
  return 0;
}

const std::map<std::string, std::function<void(World&)>> kStates{
    {"forward", [](World& w) { w.run(0.8); }},
    {"pause",
     [](World& w) {
       w.run(0.8);
       w.planner_silent = true;
       w.until(ExecutionState::kPause, 0.1);
       w.planner_silent = false;
     }},
    {"reverse",
     [](World& w) {
       w.run(0.8);
       w.velocity.y() = 0.7;
       w.until(ExecutionState::kReverse, 2);
     }},
    {"tracking", [](World& w) { w.until(ExecutionState::kTracking, 2); }},
    {"retract",
     [](World& w) {
       w.until(ExecutionState::kTracking, 2);
       w.velocity.y() = 0.7;
       w.until(ExecutionState::kRetract, 2);
     }},
    {"done", [](World& w) { w.until(ExecutionState::kDone, 4); }},
    {"stopped",
     [](World& w) {
       w.until(ExecutionState::kTracking, 2);
       w.executive().preempt();
       w.until(ExecutionState::kStopped, 0.1);
       w.forget_setpoint();
     }},
};

// To and fro in place, as images at 30 Hz show it, with peak speed `size`, in m/s.
void shake(World& world, double size, int tick) {
  world.velocity = {0, size * std::cos(2 * M_PI * 2.4 * 0.01 * tick), 0};
}

using Danger = std::function<void(World&, double size, int tick)>;
const std::map<std::string, std::pair<Danger, std::vector<double>>> kDangers{
    {"speed",
     {[](World& w, double size, int) {
        w.velocity = {0, size, 0};
      },
      {0, 0.2, 0.4, 0.7, 1.0, 1.4, 1.6, 2.5, 9, 1e6}}},
    {"spread",
     {[](World& w, double size, int) { w.measured_off = size; },
      {0, 0.2, 0.4, 0.7, 1.0, 1.6, 2.5, 9, 1e6}}},
    {"age",
     {[](World& w, double size, int tick) {
        const bool hidden = tick < 100 * size;
        w.status = hidden ? TargetStatus::kCoasting : TargetStatus::kTracking;
      },
      {0, 0.2, 0.5, 1.2, 1.8, 2.5, 5}}},
    {"reach",
     {[](World& w, double size, int) { w.position.x() = 1.0 + size; },
      {0, 0.05, 0.3, 0.6, 1.0, 2.0}}},
};

std::vector<int> reaction(const std::function<void(World&)>& lead_to, const Danger& danger,
                          double size, int ticks) {
  World world;
  lead_to(world);
  world.velocity = kStill;
  std::vector<int> result;
  for (int tick = 0; tick < ticks; ++tick) {
    danger(world, size, tick);
    result.push_back(boldness_of(world.tick().progress));
  }
  return result;
}

TEST(Reaction, GetsNoBolderAsDangerGrowsFromAnyState) {
  for (const auto& [state, lead_to] : kStates) {
    for (const auto& [name, danger] : kDangers) {
      const auto& [act, sizes] = danger;
      // As long as the smallest danger lasts in every case.
      const int ticks = name == "age" ? 200 : 300;
      std::vector<int> before;
      for (const double size : sizes) {
        std::vector<int> now = reaction(lead_to, act, size, ticks);
        for (std::size_t i = 0; i < before.size(); ++i) {
          ASSERT_LE(now[i], before[i]) << state << ", " << name << " " << size << ", tick " << i;
        }
        before = now;
      }
    }
  }
}

TEST(Reaction, LeavesTheTargetWheneverADangerLasts) {
  for (const char* state : {"tracking", "done", "stopped", "pause", "retract"}) {
    for (const double peak : {0.7, 0.9, 1.4, 1.6, 2.5, 9.0}) {
      World world;
      kStates.at(state)(world);
      world.checks_steps = false;
      for (int tick = 0; tick < 600; ++tick) {
        shake(world, peak, tick);
        world.tick();
      }
      EXPECT_EQ(world.tick().progress.cursor, 0) << state << " " << peak;
    }
    for (const double reach : {0.6, 2.0}) {
      World world;
      kStates.at(state)(world);
      world.velocity = kStill;
      world.position.x() += reach;
      world.run(4);
      EXPECT_EQ(world.tick().progress.cursor, 0) << state << " " << reach;
    }
  }
}

// The box: retract under way, and the goal leaves the reach.
TEST(Reaction, DoesNotPauseHalfWayOutWhenTheGoalLeavesTheReach) {
  World world;
  kStates.at("retract")(world);
  world.position.x() = 1.6;
  double cursor = 10;
  for (int tick = 0; tick < 100; ++tick) {
    const Progress progress = world.tick().progress;
    ASSERT_EQ(progress.state, ExecutionState::kRetract);
    ASSERT_LE(progress.cursor, cursor);
    cursor = progress.cursor;
  }
  EXPECT_EQ(cursor, 0);
}

// Unsteady is no danger for a while, and one when it lasts.
TEST(Reaction, LeavesATargetThatStaysUnsteady) {
  World world;
  world.until(ExecutionState::kDone, 4);
  world.velocity.y() = 0.25;
  EXPECT_EQ(world.run(1.5).progress.state, ExecutionState::kDone);
  world.until(ExecutionState::kRetract, 1);
}

}  // namespace
}  // namespace prf_decision
