// SPDX-License-Identifier: BSD-3-Clause
// Moves the hand 5 cm to the left of where the joints have it, and prints the joints for that.
#include <iostream>
#include <jaco_kinematics/jaco_kinematics.hpp>

int main() {
  using namespace jaco_kinematics;
  JointVector joints_now;  // rad
  joints_now << 0.98, 2.32, 1.29, 1.39, -0.84, 2.23, -1.48;

  Eigen::Isometry3d hand_in_base = forward(joints_now);
  hand_in_base.translation().y() += 0.05;

  const IkResult result = inverse(hand_in_base, joints_now);
  if (result.status != IkStatus::kSolved) {
    std::cerr << "the pose cannot be reached\n";
    return 1;
  }
  std::cout << "joints [rad]: " << result.q.transpose() << "\n"
            << "error: " << result.position_error << " m, " << result.orientation_error << " rad\n";
}
