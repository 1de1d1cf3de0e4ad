// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/stance.hpp"

#include <Eigen/QR>

#include "v60_gait/gravity.hpp"

namespace v60_gait {
namespace {

constexpr double kToeX = 0.31;                          // m
constexpr double kToeY = 0.17;                          // m
constexpr double kToeZ = -0.506;                        // m
const Eigen::Vector3d kKneesBackward(0.0, 0.83, 1.65);  // rad, near the posture

}  // namespace

std::array<std::string, 12> leg_joint_names() {
  std::array<std::string, 12> names;
  auto name = names.begin();
  for (const std::string leg : kLegNames) {
    for (const char* joint : {"_abduction", "_hip", "_knee"}) *name++ = leg + joint;
  }
  return names;
}

Stance find_stance(const RigidTree& robot) {
  Stance stance;
  for (std::size_t i = 0; i < kLegNames.size(); ++i) {
    const std::string leg = kLegNames[i];
    const double front = leg[0] == 'f' ? 1.0 : -1.0;
    const double left = leg[1] == 'l' ? 1.0 : -1.0;
    stance.legs.emplace_back(robot, leg);
    stance.toes_in_base[i] = Eigen::Vector3d(front * kToeX, left * kToeY, kToeZ);
    stance.posture.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        stance.legs.back().angles(stance.toes_in_base[i], kKneesBackward);
  }
  return stance;
}

// Balance: sum f_i = W, sum r_i x f_i = r_com x W with f_i = f_i z. Virtual work of the toes'
// forces and of the legs' own weight gives tau = tau_weight - J^T f.
LegVector standing_torques(const BodyModel& body, const Stance& stance) {
  const Eigen::Vector3d& centre = body.centre_of_mass_in_base;
  Eigen::Matrix<double, 3, 4> balance;
  for (std::size_t leg = 0; leg < 4; ++leg) {
    const Eigen::Vector3d& toe = stance.toes_in_base[leg];
    balance.col(static_cast<Eigen::Index>(leg)) << 1.0, toe.x() - centre.x(), toe.y() - centre.y();
  }
  const Eigen::Vector4d loads =
      balance.completeOrthogonalDecomposition().solve(Eigen::Vector3d(body.weight, 0.0, 0.0));

  LegVector torques;
  for (Eigen::Index leg = 0; leg < 4; ++leg) {
    const LegModel& model = stance.legs[static_cast<std::size_t>(leg)];
    const Eigen::Vector3d angles = stance.posture.segment<3>(3 * leg);
    torques.segment<3>(3 * leg) =
        model.weight_torques(angles, -kGravity * Eigen::Vector3d::UnitZ()) -
        model.jacobian(angles).transpose() * (loads[leg] * Eigen::Vector3d::UnitZ());
  }
  return torques;
}

}  // namespace v60_gait
