// SPDX-License-Identifier: BSD-3-Clause
// Whether an arm can go along a demonstrated path: from each way of standing at its beginning the
// joints are led along the path, and the way that keeps farthest from singular postures and limits
// counts.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>
#include <cstdint>
#include <elte_planner/demonstration.hpp>
#include <optional>

namespace prf_studies {

// The path of a demonstration for its target at `target` in the arm's base.
[[nodiscard]] std::vector<elte_planner::TimedPose> placed_at(
    const elte_planner::Demonstration& demonstration, const Eigen::Isometry3d& target);

struct PathReach {
  bool whole = false;
  double until = 0.0;  // s along the path: as far as the joints could be led
  std::size_t sample = 0;
  arm_kinematics::JointVector begin;  // joints at the path's beginning, empty: it is out of reach
  double speed_share = 0.0;           // greatest speed of a joint, of its limit
  double singular_value = 0.0;        // least of the Jacobian along the path, a radian for 0.3 m
  double margin = 0.0;                // rad or m, least distance from a position limit
};

// The best of `draws` ways, from random joints of the seed 1.
[[nodiscard]] PathReach path_reach(const arm_kinematics::ArmKinematics& arm,
                                   const std::vector<elte_planner::TimedPose>& path, int draws);

}  // namespace prf_studies
