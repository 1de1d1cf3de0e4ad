// SPDX-License-Identifier: BSD-3-Clause
#include "closed_form.hpp"

#include <cmath>
#include <prf_core/require.hpp>

#include "arm_angle.hpp"
#include "pose_step.hpp"

namespace jaco_kinematics {

namespace {

// Rotation from the frame behind joint `index` (1 to 7), turned by `angle`, to the next joint's.
Eigen::Matrix3d after_joint(const Eigen::Matrix3d& before, double angle, std::size_t index) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return before * turn * joint_origins()[index].rotation;
}

struct ShoulderSolution {
  double q1;
  double q2;
  ElbowCircle circle;
  Eigen::Vector3d upper_arm;
};

// The upper arm points along (cos q1 sin q2, -sin q1 sin q2, -cos q2). S depends on q1 by 1.6 mm:
// a fixed point, started at the axis, that gains more than two digits a step away from q2 = pi.
std::optional<ShoulderSolution> solve_shoulder(const Eigen::Vector3d& wrist, double phi,
                                               int branch) {
  constexpr int kIterations = 12;
  constexpr double kSettled = 1e-9;  // [rad] of q1
  const double sign = branch == 0 ? 1.0 : -1.0;
  Eigen::Vector3d shoulder(0.0, 0.0, kShoulderHeight);
  ShoulderSolution solution{};
  for (int i = 0; i < kIterations; ++i) {
    const auto circle = elbow_circle(wrist - shoulder, 2.0 * kShoulderOffset);
    if (!circle) return std::nullopt;
    solution.circle = *circle;
    const Eigen::Vector3d e = circle->upper_arm(phi);
    solution.upper_arm = e;
    const double previous = solution.q1;
    solution.q1 = std::atan2(-sign * e.y(), sign * e.x());
    solution.q2 = std::atan2(sign * std::hypot(e.x(), e.y()), -e.z());
    if (i > 0 && std::abs(wrap_angle(solution.q1 - previous)) < kSettled) break;
    shoulder = shoulder_point(solution.q1);
  }
  return solution;
}

}  // namespace

JointVector normalized_angles(const JointVector& q) {
  JointVector result;
  for (int i = 0; i < 7; ++i) {
    const double angle = wrap_angle(q[i]);
    result[i] = is_limited(i) && angle < 0.0 ? angle + 2.0 * kPi : angle;
  }
  return result;
}

std::optional<JointVector> branch_solution(const Eigen::Isometry3d& pose, double phi, int branch) {
  const Eigen::Vector3d tool_axis = pose.linear().col(2);
  const Eigen::Vector3d wrist = pose.translation() - kToolLength * tool_axis;
  const auto shoulder = solve_shoulder(wrist, phi, shoulder_of(branch));
  if (!shoulder) return std::nullopt;
  const ElbowFrame elbow = elbow_frame(shoulder->circle, shoulder->upper_arm, elbow_of(branch));

  JointVector q;
  q[0] = shoulder->q1;
  q[1] = shoulder->q2;
  Eigen::Matrix3d frame = after_joint(joint_origins()[0].rotation, q[0], 1);
  frame = after_joint(frame, q[1], 2);
  // Axis 4 is y of link 3.
  const Eigen::Vector3d axis = frame.transpose() * elbow.axis;
  q[2] = std::atan2(-axis.x(), axis.y());
  frame = after_joint(frame, q[2], 3);
  // The forearm is y of link 4.
  const Eigen::Vector3d forearm = frame.transpose() * elbow.forearm;
  q[3] = std::atan2(-forearm.x(), forearm.y());
  frame = after_joint(frame, q[3], 4);
  // Before joint 5 the tool axis is (cos q5 sin q6, sin q5 sin q6, cos q6).
  const Eigen::Vector3d tool = frame.transpose() * tool_axis;
  const double sign = wrist_of(branch) == 0 ? 1.0 : -1.0;
  q[4] = std::atan2(sign * tool.y(), sign * tool.x());
  q[5] = std::atan2(sign * std::hypot(tool.x(), tool.y()), tool.z());
  frame = after_joint(after_joint(frame, q[4], 5), q[5], 6);
  // What is left is the turn about axis 7.
  const Eigen::Matrix3d rest =
      frame.transpose() * pose.linear() * joint_origins()[7].rotation.transpose();
  q[6] = std::atan2(rest(1, 0), rest(0, 0));
  return normalized_angles(q);
}

PoseErrors pose_errors(const Frames& frames, const Eigen::Isometry3d& pose) {
  const auto difference = pose_difference(frames.end_effector, pose);
  return {difference.head<3>().norm(), difference.tail<3>().norm()};
}

bool polish(const Eigen::Isometry3d& pose, JointVector* q) {
  constexpr int kIterations = 12;  // quadratic convergence from about 1e-7
  for (int i = 0; i < kIterations; ++i) {
    const Frames frames = link_frames(*q);
    const auto difference = pose_difference(frames.end_effector, pose);
    if (difference.norm() < kPoseGoal) return true;
    JointVector step = pose_step(frames, difference).least;
    const double norm = step.norm();
    if (norm > kLargestStep) step *= kLargestStep / norm;
    *q += step;
  }
  return pose_errors(link_frames(*q), pose).met();
}

std::vector<IkSolution> inverse_at_arm_angle(const Eigen::Isometry3d& pose, double phi) {
  const Eigen::Isometry3d target = checked_pose(pose);
  prf_core::require_between("phi", phi, -kLargestAngle, kLargestAngle, "rad");
  std::vector<IkSolution> solutions;
  for (int branch = 0; branch < kBranches; ++branch) {
    auto q = branch_solution(target, phi, branch);
    if (!q || !polish(target, &*q)) continue;
    const JointVector angles = normalized_angles(*q);
    const PoseErrors errors = pose_errors(link_frames(angles), target);
    solutions.push_back(
        {branch, angles, within_limits(angles), errors.position, errors.orientation});
  }
  return solutions;
}

}  // namespace jaco_kinematics
