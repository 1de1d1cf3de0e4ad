// SPDX-License-Identifier: BSD-3-Clause
// One branch of the closed form, and Newton's polish of it. Private to the library.
#pragma once

#include <optional>

#include "geometry.hpp"

namespace jaco_kinematics {

constexpr int kBranches = 8;
inline int shoulder_of(int branch) { return branch / 4; }
inline int elbow_of(int branch) { return branch / 2 % 2; }
inline int wrist_of(int branch) { return branch % 2; }

// q of one branch, good to about 1e-7 except near q2 = pi, where the shoulder's offset has no
// direction; nothing out of reach. Angles as in IkSolution.
std::optional<JointVector> branch_solution(const Eigen::Isometry3d& pose, double phi, int branch);

// A pose is met if both errors are below this.
constexpr double kPoseTolerance = 1e-9;
constexpr double kPoseGoal = 1e-11;  // aimed at, so that the tolerance is met with room
struct PoseErrors {
  double position;
  double orientation;

  bool met() const { return position < kPoseTolerance && orientation < kPoseTolerance; }
};
PoseErrors pose_errors(const Frames& frames, const Eigen::Isometry3d& pose);

// Newton from q to the pose; false if it does not get there.
bool polish(const Eigen::Isometry3d& pose, JointVector* q);

// Continuous joints to (-pi, pi], the others to [0, 2 pi).
JointVector normalized_angles(const JointVector& q);

}  // namespace jaco_kinematics
