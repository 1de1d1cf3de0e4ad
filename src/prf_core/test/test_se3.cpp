// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/se3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "random_pose.hpp"

namespace prf_core {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d kAxis = Vector3d(1.0, -2.0, 3.0).normalized();

// Angles from the smallest to pi: also where Log's quotient is 0 / 0, and on both sides of the
// threshold below which it is replaced.
TEST(LogSo3, InvertsExpAtEveryAngle) {
  for (const double angle : {1e-150, 1e-12, 1.9e-9, 2.1e-9, 1e-6, 1e-4, 0.1, 1.0, M_PI / 2, 3.0,
                             M_PI - 1e-6, M_PI - 1e-9, M_PI - 1e-12}) {
    const Vector3d back = log_so3(Quaterniond(exp_so3(angle * kAxis)));
    EXPECT_LE((back - angle * kAxis).norm(), 1e-15 + 4e-15 * angle) << angle;
    EXPECT_NEAR(back.norm() / angle, 1.0, 1e-12) << angle;
  }
}

TEST(ExpSo3, OfAnAngleWhoseSquareUnderflowsIsTheIdentity) {
  EXPECT_EQ(exp_so3(1e-170 * kAxis).angle(), 0.0);
}

TEST(LogSo3, OfTheIdentityIsZero) {
  EXPECT_EQ(log_so3(Quaterniond::Identity()), Vector3d::Zero());
  EXPECT_EQ(log_so3(Quaterniond(-1.0, 0.0, 0.0, 0.0)), Vector3d::Zero());
}

TEST(LogSo3, IsTheSameForBothQuaternionsOfARotation) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Quaterniond q = random_rotation(random);
    EXPECT_EQ(log_so3(q), log_so3(Quaterniond(-q.coeffs()))) << i;
  }
}

TEST(LogSo3, HasAnAngleOfAtMostPi) {
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Quaterniond q = random_rotation(random);
    const Vector3d r = log_so3(q);
    EXPECT_LE(r.norm(), M_PI + 1e-15);
    EXPECT_NEAR(q.angularDistance(Quaterniond(exp_so3(r))), 0.0, 1e-7);
    EXPECT_TRUE(exp_so3(r).toRotationMatrix().isApprox(q.toRotationMatrix(), 1e-14));
  }
  const Vector3d half_turn = log_so3(Quaterniond(0.0, 0.6, 0.0, 0.8));
  EXPECT_TRUE(half_turn.isApprox(M_PI * Vector3d(0.6, 0.0, 0.8), 1e-15));
}

TEST(ExpSo3, AddsAnglesAboutOneAxis) {
  const Quaterniond sum = Quaterniond(exp_so3(0.3 * kAxis)) * Quaterniond(exp_so3(0.5 * kAxis));
  EXPECT_TRUE(sum.isApprox(Quaterniond(exp_so3(0.8 * kAxis)), 1e-15));
  EXPECT_EQ(exp_so3(Vector3d::Zero()).angle(), 0.0);
}

// The perturbation is on the left: R' = Exp(r) R, r in the parent frame.
TEST(RotationBetween, IsTheLeftPerturbation) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Quaterniond from = random_rotation(random);
    const Vector3d r = random_vector(random, 1.5);  // |r| < 1.5 sqrt(3) < pi
    const Quaterniond to = Quaterniond(exp_so3(r)) * from;
    EXPECT_LE((rotation_between(from, to) - r).norm(), 1e-14);
    EXPECT_LE((rotation_between(to, from) + r).norm(), 1e-14);
  }
  const Quaterniond quarter(exp_so3(M_PI / 2 * Vector3d::UnitZ()));
  const Quaterniond tilted = Quaterniond(exp_so3(0.1 * Vector3d::UnitX())) * quarter;
  EXPECT_TRUE(rotation_between(quarter, tilted).isApprox(0.1 * Vector3d::UnitX(), 1e-14));
}

TEST(RotationBetween, TakesTheShortWay) {
  const Eigen::Quaterniond from(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  Eigen::Quaterniond to(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  to.coeffs() = -to.coeffs();
  EXPECT_LT((rotation_between(from, to) - Eigen::Vector3d(0.3, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(rotation_between(from, from).norm(), 0);
}

TEST(Pose, BecomesAnIsometryAndComesBack) {
  std::mt19937 random(4);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random_pose(random);
    const Pose back = pose_from(pose.isometry());
    EXPECT_EQ(back.position, pose.position);
    EXPECT_LE(rotation_between(back.orientation, pose.orientation).norm(), 1e-14);
    const Vector3d point = random_vector(random, 1.0);
    EXPECT_TRUE((pose.isometry() * point).isApprox(pose.position + pose.orientation * point));
  }
}

// Fault 1, 2, 43: a pose that is not finite, too far or not of unit norm -> refused by name
TEST(RequirePose, NamesWhatIsNotFiniteOrNotUnit) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto message = [](const Pose& pose) {
    try {
      require_pose("goal", pose);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({}), "");
  EXPECT_EQ(message({Vector3d::Zero(), Quaterniond(1.0009, 0, 0, 0)}), "");
  EXPECT_EQ(message({Vector3d(0, nan, 0), Quaterniond::Identity()}),
            "goal.position =   0 nan   0, must be finite and within +-10000 m");
  EXPECT_NE(message({Vector3d(0, 0, -1e300), Quaterniond::Identity()}), "");
  EXPECT_EQ(message({Vector3d::Zero(), Quaterniond(1.002, 0, 0, 0)}),
            "goal.orientation's norm = 1.002, must be 1 within 0.001");
  EXPECT_NE(message({Vector3d::Zero(), Quaterniond(nan, 0, 0, 0)}), "");
  EXPECT_NE(message({Vector3d::Zero(), Quaterniond(0, 0, 0, 0)}), "");
}

// The velocity of the attached frame is the derivative of its pose.
TEST(RigidlyAttached, MovesWithItsCarrier) {
  std::mt19937 random(5);
  const double dt = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const MovingPose carrier = random_moving_pose(random);
    const Pose mount = random_pose(random);
    MovingPose later = carrier;
    later.pose.position += dt * carrier.linear_velocity;
    later.pose.orientation = exp_so3(dt * carrier.angular_velocity) * carrier.pose.orientation;
    const MovingPose now = rigidly_attached(carrier, mount);
    const MovingPose then = rigidly_attached(later, mount);
    EXPECT_TRUE(now.pose.isometry().isApprox(carrier.pose.isometry() * mount.isometry(), 1e-14));
    const Vector3d linear = (then.pose.position - now.pose.position) / dt;
    const Vector3d angular = rotation_between(now.pose.orientation, then.pose.orientation) / dt;
    EXPECT_LE((linear - now.linear_velocity).norm(), 1e-5);
    EXPECT_LE((angular - now.angular_velocity).norm(), 1e-5);
  }
}

TEST(Interpolate, HitsEndPointsAndTheirVelocities) {
  std::mt19937 random(6);
  for (const double span : {0.01, 1.0, 7.0}) {
    for (int i = 0; i < 100; ++i) {
      const MovingPose start = random_moving_pose(random);
      const MovingPose end = random_moving_pose(random);
      const MovingPose first = interpolate(start, end, span, 0.0);
      const MovingPose last = interpolate(start, end, span, span);
      EXPECT_LE((first.pose.position - start.pose.position).norm(), 1e-13);
      EXPECT_LE((last.pose.position - end.pose.position).norm(), 1e-13);
      EXPECT_LE((first.linear_velocity - start.linear_velocity).norm(), 1e-13);
      EXPECT_LE((last.linear_velocity - end.linear_velocity).norm(), 2e-13 + 1e-14 / span);
      EXPECT_LE(rotation_between(first.pose.orientation, start.pose.orientation).norm(), 1e-13);
      EXPECT_LE(rotation_between(last.pose.orientation, end.pose.orientation).norm(), 1e-13);
    }
  }
}

TEST(Interpolate, HasTheVelocityOfItsOwnMotion) {
  std::mt19937 random(7);
  const double dt = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const MovingPose start = random_moving_pose(random);
    const MovingPose end = random_moving_pose(random);
    for (const double time : {0.1, 0.5, 1.3}) {
      const MovingPose now = interpolate(start, end, 1.5, time);
      const MovingPose before = interpolate(start, end, 1.5, time - dt);
      const MovingPose after = interpolate(start, end, 1.5, time + dt);
      const Vector3d linear = (after.pose.position - before.pose.position) / (2 * dt);
      const Vector3d angular =
          rotation_between(before.pose.orientation, after.pose.orientation) / (2 * dt);
      EXPECT_LE((linear - now.linear_velocity).norm(), 1e-8);
      EXPECT_LE((angular - now.angular_velocity).norm(), 1e-8);
    }
  }
}

TEST(Interpolate, FollowsAMotionOfConstantVelocity) {
  const MovingPose start{
      {Vector3d(1, 2, 3), Quaterniond::Identity()}, Vector3d(0.1, 0, -0.2), Vector3d::Zero()};
  MovingPose end = start;
  end.pose.position += 2.0 * start.linear_velocity;
  const MovingPose at = interpolate(start, end, 2.0, 0.7);
  EXPECT_TRUE(at.pose.position.isApprox(start.pose.position + 0.7 * start.linear_velocity, 1e-15));
  EXPECT_TRUE(at.linear_velocity.isApprox(start.linear_velocity, 1e-14));
}

TEST(Interpolate, TurnsTheShorterWayWhicheverSignTheQuaternionHas) {
  MovingPose start, end;
  end.pose.orientation = exp_so3(0.4 * kAxis);
  const MovingPose middle = interpolate(start, end, 2.0, 1.0);
  end.pose.orientation.coeffs() *= -1.0;
  const MovingPose same = interpolate(start, end, 2.0, 1.0);
  for (const MovingPose& at : {middle, same}) {
    EXPECT_LE((log_so3(at.pose.orientation) - 0.2 * kAxis).norm(), 1e-15);
    EXPECT_LE((at.angular_velocity - 0.2 * kAxis).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace prf_core
