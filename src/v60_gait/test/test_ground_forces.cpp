// SPDX-License-Identifier: BSD-3-Clause
#include "ground_forces.hpp"

#include <gtest/gtest.h>

#include <random>

namespace v60_gait {
namespace {

using Forces = std::vector<Eigen::Vector3d>;
const Forces kFeet{
    {0.31, 0.17, -0.5}, {0.31, -0.17, -0.5}, {-0.31, 0.17, -0.5}, {-0.31, -0.17, -0.5}};

Forces distribute_repeatedly(const Wrench& wanted, const Forces& feet, double friction) {
  Forces forces(feet.size(), Eigen::Vector3d::Zero());
  for (int i = 0; i < 200; ++i) forces = distribute_wrench(wanted, feet, friction, forces);
  return forces;
}

TEST(GroundForces, ReachAWrenchThatTheFeetCanGive) {
  const Wrench wanted{{20.0, -30.0, 560.0}, {10.0, -15.0, 4.0}};
  const Forces forces = distribute_repeatedly(wanted, kFeet, 0.6);
  Wrench reached;
  for (std::size_t i = 0; i < kFeet.size(); ++i) {
    reached.force += forces[i];
    reached.torque += kFeet[i].cross(forces[i]);
  }
  EXPECT_LT((reached.force - wanted.force).norm(), 1.0);
  EXPECT_LT((reached.torque - wanted.torque).norm(), 0.5);
}

TEST(GroundForces, OneCallFromTheLastForcesIsEnoughForASlowlyChangingWrench) {
  Wrench wanted{{0.0, 0.0, 560.0}, {0.0, 0.0, 0.0}};
  Forces forces = distribute_repeatedly(wanted, kFeet, 0.6);
  for (int step = 0; step < 100; ++step) {
    wanted.torque.x() += 0.1;
    forces = distribute_wrench(wanted, kFeet, 0.6, forces);
  }
  const Forces best = distribute_repeatedly(wanted, kFeet, 0.6);
  for (std::size_t i = 0; i < kFeet.size(); ++i) EXPECT_LT((forces[i] - best[i]).norm(), 1.0);
}

TEST(GroundForces, NeverLeaveTheFrictionCone) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  const auto vector = [&](double scale) {
    return Eigen::Vector3d(scale * draw(generator), scale * draw(generator),
                           scale * draw(generator));
  };
  for (int i = 0; i < 2000; ++i) {
    const double friction = 0.1 + 0.4 * (draw(generator) + 1.0);
    const Forces guess{vector(500.0), vector(500.0), vector(500.0), vector(500.0)};
    const Wrench wanted{vector(1000.0), vector(300.0)};
    for (const Eigen::Vector3d& force : distribute_wrench(wanted, kFeet, friction, guess)) {
      EXPECT_GE(force.z(), -1e-9);
      EXPECT_LE(force.head<2>().norm(), friction * force.z() + 1e-9);
    }
  }
}

TEST(GroundForces, AreZeroWhenPulledDownward) {
  for (const Eigen::Vector3d& force :
       distribute_repeatedly({{0.0, 0.0, -100.0}, {0.0, 0.0, 0.0}}, kFeet, 0.6)) {
    EXPECT_LT(force.norm(), 1e-9);
  }
}

}  // namespace
}  // namespace v60_gait
