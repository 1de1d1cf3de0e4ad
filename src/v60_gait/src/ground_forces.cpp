// SPDX-License-Identifier: BSD-3-Clause
#include "ground_forces.hpp"

#include <algorithm>

namespace v60_gait {
namespace {

constexpr int kIterations = 60;           // within 1 N of the minimum, as the test shows
constexpr double kLength = 0.3;           // l, m, about half the distance of the feet
constexpr double kRegularisation = 1e-3;  // a, makes the minimum unique

// Nearest point of the cone |(x, y)| <= mu z.
Eigen::Vector3d project_on_cone(const Eigen::Vector3d& force, double friction) {
  const double lateral = force.head<2>().norm();
  if (lateral <= friction * force.z()) return force;
  const double height = (friction * lateral + force.z()) / (1.0 + friction * friction);
  if (height <= 0.0) return Eigen::Vector3d::Zero();
  const Eigen::Vector2d direction = force.head<2>() / lateral;
  return {friction * height * direction.x(), friction * height * direction.y(), height};
}

}  // namespace

std::vector<Eigen::Vector3d> distribute_wrench(const Wrench& wanted,
                                               const std::vector<Eigen::Vector3d>& feet,
                                               double friction,
                                               const std::vector<Eigen::Vector3d>& guess) {
  std::vector<Eigen::Vector3d> forces = guess;
  // The Hessian's largest eigenvalue is at most that of a body with all feet at the farthest one.
  double farthest = 0.0;
  for (const Eigen::Vector3d& foot : feet) farthest = std::max(farthest, foot.squaredNorm());
  const double curvature =
      static_cast<double>(feet.size()) * (1.0 + farthest / (kLength * kLength)) + kRegularisation;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Wrench excess{-wanted.force, -wanted.torque};
    for (std::size_t i = 0; i < feet.size(); ++i) {
      excess.force += forces[i];
      excess.torque += feet[i].cross(forces[i]);
    }
    for (std::size_t i = 0; i < feet.size(); ++i) {
      // Gradient: excess force + (excess torque / l^2) x r_i + a f_i.
      const Eigen::Vector3d gradient = excess.force +
                                       excess.torque.cross(feet[i]) / (kLength * kLength) +
                                       kRegularisation * forces[i];
      forces[i] = project_on_cone(forces[i] - gradient / curvature, friction);
    }
  }
  return forces;
}

}  // namespace v60_gait
