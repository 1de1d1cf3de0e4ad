// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_refused.hpp"

namespace prf_core {
namespace {

Trajectory straight() {
  Trajectory trajectory;
  for (int i = 0; i <= 10; ++i) {
    trajectory.poses.push_back({{0.3 + 0.03 * i, 0, 0.5}, Eigen::Quaterniond::Identity()});
    trajectory.times.push_back(std::chrono::milliseconds(100 * i));
  }
  return trajectory;
}

TEST(Trajectory, RefusesWhatCannotBeExecuted) {
  expect_refused<Trajectory>(
      straight(),
      {{"number of poses = 1, must be at least 2", [](auto& t) { t.poses.resize(1); }},
       {"number of times = 12, must be that of the poses, 11",
        [](auto& t) { t.times.push_back(Duration{1}); }},
       {"times[0] = 0.001, must be 0 s", [](auto& t) { t.times[0] = Duration{1000000}; }},
       {"times[4] = 0.3, must be greater than before", [](auto& t) { t.times[4] = t.times[3]; }},
       {"poses[7].position", [](auto& t) { t.poses[7].position.z() = NAN; }},
       {"poses[10].orientation's norm = 0.5, must be 1 within 0.001",
        [](auto& t) { t.poses[10].orientation.w() = 0.5; }},
       {"goal_in_target", [](auto& t) { t.goal_in_target.orientation.w() = NAN; }}});
}

}  // namespace
}  // namespace prf_core
