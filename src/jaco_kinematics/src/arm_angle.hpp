// SPDX-License-Identifier: BSD-3-Clause
// The elbow's circle about the line from shoulder S to wrist centre W, and the part of it that the
// limits of joints 2 and 6 allow. Private to the library.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry.hpp"

namespace jaco_kinematics {

// Orthonormal right-handed: `axis` from S to W, `zero` the direction of arm angle 0.
struct ArmAxes {
  Eigen::Vector3d axis;
  Eigen::Vector3d zero;
  Eigen::Vector3d ninety;
};
ArmAxes arm_axes(const Eigen::Vector3d& shoulder_to_wrist);

// Directions of the upper arm for a given S -> W: cos(a) axis + sin(a) (cos phi zero + sin phi
// ninety).
struct ElbowCircle {
  ArmAxes axes;
  Eigen::Vector3d shoulder_to_wrist;
  double cos_a;
  double sin_a;

  Eigen::Vector3d upper_arm(double phi) const;
};

// Nothing if the triangle of upper arm and forearm cannot close. A distance outside its range by
// less than `slack` is taken as the bound.
std::optional<ElbowCircle> elbow_circle(const Eigen::Vector3d& shoulder_to_wrist, double slack);

struct ElbowFrame {
  Eigen::Vector3d axis;     // of joint 4
  Eigen::Vector3d forearm;  // from the elbow axis to W, normal to it
};
// The two elbow axes a with a . upper_arm = 0 and a . (W - E) = kElbowOffset; `branch` 0 or 1.
ElbowFrame elbow_frame(const ElbowCircle& circle, const Eigen::Vector3d& upper_arm, int branch);

struct Arc {
  double begin;
  double end;  // begin <= end <= begin + 2 pi
};
// Where upper arm and forearm keep joints 2 and 6 within limits (widened by `slack` in the cosine),
// with the shoulder's 1.6 mm offset neglected. At most two.
std::vector<Arc> feasible_arcs(const ElbowCircle& circle, int elbow_branch,
                               const Eigen::Vector3d& tool_axis, double slack);

double arm_angle(const Frames& frames);

}  // namespace jaco_kinematics
