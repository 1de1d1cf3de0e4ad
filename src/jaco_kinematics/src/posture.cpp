// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "arm_angle.hpp"
#include "geometry.hpp"
#include "pose_step.hpp"

namespace jaco_kinematics {

namespace {

// [rad] Ours: from there to a limit of joint 2 or 6 the limit pushes.
constexpr double kMargin = 0.6;
// [rad] Ours: so near the elbow upright, on either side, the way away from there ends.
constexpr double kUpright = 0.05;
// Ours: slope at which the motion has 0.7 of its full length; below, it is proportional, so that it
// ends without chatter.
constexpr double kGentleSlope = 0.3;

// Change of the arm angle with the self-motion, which leaves the wrist centre in place: the
// elbow's velocity about the line from shoulder to wrist, by its distance from there.
double arm_angle_rate(const Frames& frames, const JointVector& direction) {
  const Eigen::Vector3d shoulder = frames.origin[1];
  const Eigen::Vector3d axis = (frames.origin[5] - shoulder).normalized();
  const Eigen::Vector3d upper_arm = frames.origin[3] - shoulder;
  const Eigen::Vector3d across = upper_arm - upper_arm.dot(axis) * axis;
  const Eigen::Vector3d turn =
      direction[0] * frames.rotation[0].col(2) + direction[1] * frames.rotation[1].col(2);
  return turn.cross(upper_arm).dot(axis.cross(across)) / across.squaredNorm();
}

// To the preferred arm angle, at most 1 rad, on the side where the elbow does not go through the
// upright: there joint 2 is singular, joints 1 and 3 turn fast for little motion of the hand, and
// an arm whose hand moves does not get through.
double way_to_preferred(double phi) {
  const double below = phi < 0.0 ? phi + 2.0 * kPi : phi;
  return std::clamp(kPreferredArmAngle - below, -1.0, 1.0) *
         std::min(1.0, std::abs(phi) / kUpright);
}

// Of joint 2 and 6, 0 from kMargin on and 1 at the limit. (Joint 4 is fixed by the hand's pose.)
double limit_slope(const JointVector& q, const JointVector& direction) {
  double sum = 0.0;
  for (int i : {1, 5}) {
    const double from_middle = q[i] - kPi;
    const double to_limit = jaco_joint_limits().upper[i] - kPi - std::abs(from_middle);
    const double depth = std::clamp(1.0 - to_limit / kMargin, 0.0, 1.0);
    sum -= direction[i] * std::copysign(depth, from_middle);
  }
  return sum;
}

}  // namespace

JointVector posture_motion(const JointVector& q) {
  check_angles(q, "q");
  const Frames frames = link_frames(q);
  const JointVector direction = pose_step(frames, Eigen::Matrix<double, 6, 1>::Zero()).self_motion;
  const double slope = way_to_preferred(arm_angle(frames)) * arm_angle_rate(frames, direction) +
                       limit_slope(q, direction);
  return slope / std::hypot(slope, kGentleSlope) * direction;
}

}  // namespace jaco_kinematics
