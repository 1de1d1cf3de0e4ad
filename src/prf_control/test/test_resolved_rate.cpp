// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/resolved_rate.hpp"

#include <gtest/gtest.h>

#include <jaco_kinematics/jaco_kinematics.hpp>
#include <random>

namespace prf_control {
namespace {

constexpr double kWeight = 0.2;  // m/rad

JointVector home() { return (JointVector(7) << 0.3, 3.9, 0.2, 1.9, 0.4, 2.4, -0.3).finished(); }

VelocityRange range_of(double bound) {
  return {JointVector::Constant(7, -bound), JointVector::Constant(7, bound)};
}

JointVector random_joints(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return JointVector::NullaryExpr(7, [&] { return uniform(random); });
}

Twist random_twist(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Twist::NullaryExpr([&] { return uniform(random); });
}

// Of |W (J v - x)|^2 / 2 + kNullSpaceWeight |v - v_p|^2 / 2.
JointVector gradient(const ResolvedRateProblem& request, const JointVector& v) {
  Twist squared;
  squared << 1, 1, 1, kWeight * kWeight, kWeight * kWeight, kWeight * kWeight;
  return request.jacobian.transpose() * squared.cwiseProduct(request.jacobian * v - request.twist) +
         kNullSpaceWeight * (v - request.null_space_velocity);
}

TEST(ResolvedRate, MovesHandAndPostureAsWantedWhereNothingBinds) {
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    const JointVector wanted = random_joints(random, 0.5);
    const auto J = jaco_kinematics::jacobian(home());
    const JointVector v = resolved_rate({J, J * wanted, wanted, kWeight}, range_of(1.0));
    EXPECT_LE((v - wanted).norm(), 1e-8);
  }
}

TEST(ResolvedRate, IsTheMinimumWithinTheRange) {
  std::mt19937 random(7);
  int at_bounds = 0;
  for (int i = 0; i < 300; ++i) {
    const ResolvedRateProblem request{
        jaco_kinematics::jacobian(home() + random_joints(random, 0.3)), random_twist(random),
        random_joints(random, 1.0), kWeight};
    const JointVector middle = random_joints(random, 0.3);
    const VelocityRange range{middle.array() - 0.2, middle.array() + 0.2};
    const JointVector v = resolved_rate(request, range);
    const JointVector slope = gradient(request, v);
    for (int joint = 0; joint < 7; ++joint) {
      ASSERT_GE(v[joint], range.lower[joint]);
      ASSERT_LE(v[joint], range.upper[joint]);
      const bool at_lower = v[joint] == range.lower[joint];
      const bool at_upper = v[joint] == range.upper[joint];
      ASSERT_TRUE(at_upper || slope[joint] >= -1e-8) << slope[joint];
      ASSERT_TRUE(at_lower || slope[joint] <= 1e-8) << slope[joint];
      at_bounds += at_lower || at_upper ? 1 : 0;
    }
  }
  EXPECT_GT(at_bounds, 300);
}

TEST(ResolvedRate, LetsTheOtherJointsMakeUpForOneAtItsLimit) {
  const auto J = jaco_kinematics::jacobian(home());
  const JointVector wanted = (JointVector(7) << 1.0, 0.1, 0.2, 0.1, -0.2, 0.1, 0.1).finished();
  VelocityRange range = range_of(0.8);
  range.upper[0] = 0.5;
  const Twist twist = J * wanted;
  const JointVector v = resolved_rate({J, twist, wanted, kWeight}, range);
  const double left_over = (J * v - twist).head<3>().norm();
  const double when_scaled = (0.5 * twist).head<3>().norm();
  EXPECT_LE(left_over, 0.2 * when_scaled);
}

}  // namespace
}  // namespace prf_control
