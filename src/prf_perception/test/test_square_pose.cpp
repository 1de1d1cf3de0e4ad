// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/square_pose.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <random>

namespace prf_perception {
namespace {

constexpr double kSide = 0.1;
constexpr CornerErrorModel kModel{0.1, 0.0003, 0.002};
constexpr CameraIntrinsics kCamera{615, 600, 320, 240, 640, 480};

Eigen::Isometry3d facing(double distance, double about_x, double about_y) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.03, -0.02, 1) * distance;
  pose.linear() =
      (Eigen::Quaterniond(0, 1, 0, 0) * Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return pose;
}

TEST(SquarePose, RecoversThePoseOfExactCornersFromARoughGuess) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> tilt(-1.0, 1.0);
  std::uniform_real_distribution<double> distance(0.2, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    const auto truth = facing(distance(random), tilt(random), tilt(random));
    auto guess = truth;
    guess.translation() *= 1.1;
    guess.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized()));
    const auto found =
        estimate_square_pose(project_corners(truth, kSide, kCamera), kCamera, kSide, guess, kModel);
    ASSERT_TRUE(found);
    EXPECT_LT((found->marker_in_camera.matrix() - truth.matrix()).norm(), 1e-6);
    EXPECT_LT(found->reprojection_error, 1e-6);
    EXPECT_GE(found->other_error, found->reprojection_error);
  }
}

TEST(SquarePose, ReturnsTheLowerMinimumWhenTheGuessIsInTheOther) {
  const auto truth = facing(0.5, 0.5, -0.3);
  const auto mirrored = facing(0.5, -0.45, 0.35);
  const auto found = estimate_square_pose(project_corners(truth, kSide, kCamera), kCamera, kSide,
                                          mirrored, kModel);
  ASSERT_TRUE(found);
  EXPECT_LT((found->marker_in_camera.matrix() - truth.matrix()).norm(), 1e-6);
}

TEST(SquarePose, CovarianceIsPositiveDefiniteAndGrowsWithDistance) {
  double last = 0;
  for (const double distance : {0.2, 0.4, 0.8, 1.6}) {
    const auto truth = facing(distance, 0.4, 0.3);
    const auto found =
        estimate_square_pose(project_corners(truth, kSide, kCamera), kCamera, kSide, truth, kModel);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->covariance.isApprox(found->covariance.transpose()));
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(found->covariance).eigenvalues().minCoeff(),
              0);
    EXPECT_GT(found->covariance(2, 2), last);
    last = found->covariance(2, 2);
  }
}

TEST(SquarePose, IsUncertainAboutItsOrientationWhereTheTwoMinimaAreAlike) {
  const auto clear = facing(0.25, 0.6, 0.0);
  const auto ambiguous = facing(3.0, 0.15, 0.0);
  const auto near =
      estimate_square_pose(project_corners(clear, kSide, kCamera), kCamera, kSide, clear, kModel);
  const auto far = estimate_square_pose(project_corners(ambiguous, kSide, kCamera), kCamera, kSide,
                                        ambiguous, kModel);
  ASSERT_TRUE(near && far);
  EXPECT_GT(near->other_error, 1.0);
  EXPECT_LT(far->other_error, 0.1);
  const Eigen::Matrix3d orientation = far->covariance.bottomRightCorner<3, 3>();
  EXPECT_GT(orientation.trace(), 0.5 * 0.3 * 0.3);
}

TEST(SquarePose, RefusesCornersThatAreNoSquareInFrontOfTheCamera) {
  const auto truth = facing(0.5, 0.3, 0.3);
  auto corners = project_corners(truth, kSide, kCamera);
  corners[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(estimate_square_pose(corners, kCamera, kSide, truth, kModel));
  auto behind = truth;
  behind.translation().z() = -0.5;
  EXPECT_FALSE(
      estimate_square_pose(project_corners(truth, kSide, kCamera), kCamera, kSide, behind, kModel));
}

}  // namespace
}  // namespace prf_perception
