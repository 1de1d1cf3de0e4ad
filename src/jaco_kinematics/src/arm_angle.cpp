// SPDX-License-Identifier: BSD-3-Clause
#include "arm_angle.hpp"

#include <algorithm>
#include <cmath>

namespace jaco_kinematics {

namespace {

// phi with constant + cosine cos(phi) + sine sin(phi) >= bound.
std::optional<Arc> arc_above(double constant, double cosine, double sine, double bound) {
  const double amplitude = std::hypot(cosine, sine);
  const double level = bound - constant;
  if (level > amplitude) return std::nullopt;
  if (level <= -amplitude) return Arc{-kPi, kPi};
  const double centre = std::atan2(sine, cosine);
  const double half_width = std::acos(level / amplitude);
  return Arc{centre - half_width, centre + half_width};
}

bool is_circle(const Arc& arc) { return arc.end - arc.begin >= 2.0 * kPi; }

std::vector<Arc> intersection(const Arc& a, const Arc& b) {
  if (is_circle(a)) return {b};
  if (is_circle(b)) return {a};
  std::vector<Arc> result;
  for (int turn = -2; turn <= 2; ++turn) {
    const double shift = 2.0 * kPi * turn;
    const double begin = std::max(a.begin, b.begin + shift);
    const double end = std::min(a.end, b.end + shift);
    if (begin <= end) result.push_back({begin, end});
  }
  return result;
}

}  // namespace

ArmAxes arm_axes(const Eigen::Vector3d& shoulder_to_wrist) {
  constexpr double kVertical = 1e-6;  // sine of the angle to the vertical; no direction below
  ArmAxes axes;
  axes.axis = shoulder_to_wrist.normalized();
  const bool vertical = std::hypot(axes.axis.x(), axes.axis.y()) < kVertical;
  const Eigen::Vector3d reference =
      vertical ? Eigen::Vector3d::UnitX().eval() : Eigen::Vector3d::UnitZ().eval();
  axes.zero = (reference - reference.dot(axes.axis) * axes.axis).normalized();
  axes.ninety = axes.axis.cross(axes.zero);
  return axes;
}

Eigen::Vector3d ElbowCircle::upper_arm(double phi) const {
  return cos_a * axes.axis + sin_a * (std::cos(phi) * axes.zero + std::sin(phi) * axes.ninety);
}

std::optional<ElbowCircle> elbow_circle(const Eigen::Vector3d& shoulder_to_wrist, double slack) {
  // Stretched and folded, the forearm lies in one plane with the upper arm, the offset beside it.
  static const double kFarthest = std::hypot(kUpperArm + kForearm, kElbowOffset);
  static const double kNearest = std::hypot(kUpperArm - kForearm, kElbowOffset);
  const double distance = shoulder_to_wrist.norm();
  const bool closes = distance <= kFarthest + slack && distance >= kNearest - slack;
  if (!closes) return std::nullopt;

  const double d = std::clamp(distance, kNearest, kFarthest);
  constexpr double kForearmSquared = kForearm * kForearm + kElbowOffset * kElbowOffset;
  ElbowCircle circle;
  circle.axes = arm_axes(shoulder_to_wrist);
  circle.shoulder_to_wrist = d * circle.axes.axis;
  circle.cos_a = (kUpperArm * kUpperArm + d * d - kForearmSquared) / (2.0 * kUpperArm * d);
  circle.sin_a = std::sqrt(std::max(0.0, 1.0 - circle.cos_a * circle.cos_a));
  return circle;
}

ElbowFrame elbow_frame(const ElbowCircle& circle, const Eigen::Vector3d& upper_arm, int branch) {
  const Eigen::Vector3d elbow_to_wrist = circle.shoulder_to_wrist - kUpperArm * upper_arm;
  const Eigen::Vector3d across = elbow_to_wrist - elbow_to_wrist.dot(upper_arm) * upper_arm;
  const double width = across.norm();
  const double cosine = std::clamp(kElbowOffset / width, -1.0, 1.0);
  const double sine = (branch == 0 ? 1.0 : -1.0) * std::sqrt(1.0 - cosine * cosine);
  ElbowFrame frame;
  frame.axis = (cosine * across + sine * upper_arm.cross(across)) / width;
  frame.forearm = (elbow_to_wrist - elbow_to_wrist.dot(frame.axis) * frame.axis).normalized();
  return frame;
}

std::vector<Arc> feasible_arcs(const ElbowCircle& circle, int elbow_branch,
                               const Eigen::Vector3d& tool_axis, double slack) {
  // q2: the upper arm's height is -cos q2; q6: the forearm's part along the tool is -cos q6.
  const JointLimits& limits = jaco_joint_limits();
  const double least_height = -std::cos(limits.lower[1]) - slack;
  const double least_alignment = -std::cos(limits.lower[5]) - slack;

  const ArmAxes& axes = circle.axes;
  const auto shoulder = arc_above(circle.cos_a * axes.axis.z(), circle.sin_a * axes.zero.z(),
                                  circle.sin_a * axes.ninety.z(), least_height);
  if (!shoulder) return {};

  // The forearm turns with phi about the axis from its place at phi = 0.
  const Eigen::Vector3d forearm = elbow_frame(circle, circle.upper_arm(0.0), elbow_branch).forearm;
  const double along = forearm.dot(axes.axis);
  const Eigen::Vector3d across = forearm - along * axes.axis;
  const auto wrist = arc_above(along * axes.axis.dot(tool_axis), across.dot(tool_axis),
                               axes.axis.cross(across).dot(tool_axis), least_alignment);
  if (!wrist) return {};
  return intersection(*shoulder, *wrist);
}

double arm_angle(const Frames& frames) {
  const Eigen::Vector3d shoulder = frames.origin[1];
  const Eigen::Vector3d elbow = frames.origin[3];
  const ArmAxes axes = arm_axes(frames.origin[5] - shoulder);
  return std::atan2((elbow - shoulder).dot(axes.ninety), (elbow - shoulder).dot(axes.zero));
}

double arm_angle(const JointVector& q) {
  check_angles(q, "q");
  return arm_angle(link_frames(q));
}

}  // namespace jaco_kinematics
