// SPDX-License-Identifier: BSD-3-Clause
#include "descent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "closed_form.hpp"
#include "pose_step.hpp"

namespace jaco_kinematics {

namespace {

// Ours: with so many, test_jaco_inverse meets 10,000 random poses to 1e-9 from a far seed. A near
// seed takes two or three.
constexpr int kSelfMotionSteps = 10;
constexpr int kSteps = 22;
constexpr double kSettled = 1e-4;  // [rad] of self-motion; the next would be a tenth or less

// `length` changed so little that q + length * direction keeps joints 2, 4, 6 within limits.
double limited_length(const JointVector& q, const JointVector& direction, double length) {
  constexpr double kInset = 1e-7;  // [rad], room for the Newton steps that follow
  constexpr double kStill = 1e-6;  // a joint that moves by less of the length does not bound it
  const JointLimits& limits = jaco_joint_limits();
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  for (int i : {1, 3, 5}) {
    if (std::abs(direction[i]) < kStill) continue;
    const double a = (limits.lower[i] + kInset - q[i]) / direction[i];
    const double b = (limits.upper[i] - kInset - q[i]) / direction[i];
    least = std::max(least, std::min(a, b));
    most = std::min(most, std::max(a, b));
  }
  return least <= most ? std::clamp(length, least, most) : length;
}

}  // namespace

bool descend(const Eigen::Isometry3d& pose, const IkCost& cost, JointVector* q, Frames* frames) {
  bool settled = false;
  for (int i = 0; i < kSteps; ++i) {
    *frames = link_frames(*q);
    const auto difference = pose_difference(frames->end_effector, pose);
    if (settled && difference.norm() < kPoseGoal) return within_limits(*q);
    auto [step, direction] = pose_step(*frames, difference);
    if (step.norm() > kLargestStep) step *= kLargestStep / step.norm();
    if (!settled) {
      const JointVector moved = *q + step;
      const double wanted = cost.self_motion(moved, direction);
      const double length =
          std::clamp(limited_length(moved, direction, wanted), -kLargestStep, kLargestStep);
      step += length * direction;
      settled = i + 1 == kSelfMotionSteps || std::abs(length) < kSettled;
    }
    *q += step;
  }
  *frames = link_frames(*q);
  return pose_errors(*frames, pose).met() && within_limits(*q);
}

}  // namespace jaco_kinematics
