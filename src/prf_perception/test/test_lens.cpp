// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/lens.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <opencv2/calib3d.hpp>
#include <random>

namespace prf_perception {
namespace {

CameraIntrinsics camera_with(const std::array<double, 8>& distortion,
                             LensModel lens = LensModel::kBrown) {
  return {615, 610, 322, 238, 640, 480, distortion, lens};
}

const std::array<CameraIntrinsics, 6> kLenses{
    camera_with({0.1, -0.2, 0.0008, -0.0006, 0.08}),
    camera_with({-0.3, 0.1, 0.002, 0.001, 0.0}),
    camera_with({0.2, 0.0, 0.0, 0.0, 0.0}),
    camera_with({0.4, -0.1, 0.0008, -0.0006, 0.02, 0.7, -0.05, 0.01}),
    camera_with({}, LensModel::kEquidistant),
    camera_with({-0.03, 0.01, -0.004, 0.001}, LensModel::kEquidistant)};

// A square somewhere in the image, as wide as a marker from 0.3 m.
Corners random_square(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Vector2d centre(320 + 150 * uniform(random), 240 + 90 * uniform(random));
  const Eigen::Rotation2Dd turn(3.0 * uniform(random));
  const double half = 100.0;
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] =
        centre + turn * Eigen::Vector2d(i == 0 || i == 3 ? -half : half, i < 2 ? half : -half);
  }
  return corners;
}

// Intersections of straight lines fitted to the bent edges: y or x as a polynomial of degree 1.
Corners fitted_corners(const Corners& ideal, const CameraIntrinsics& camera) {
  constexpr int kSamples = 25;
  std::array<Eigen::Hyperplane<double, 2>, 4> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d along = ideal[(i + 1) % 4] - ideal[i];
    const bool steep = std::abs(along.y()) > std::abs(along.x());
    Eigen::MatrixXd A(kSamples, 2);
    Eigen::VectorXd b(kSamples);
    for (int k = 0; k < kSamples; ++k) {
      const Eigen::Vector2d seen =
          distorted(ideal[i] + (k + 1.0) / (kSamples + 1.0) * along, camera);
      A.row(k) << 1.0, steep ? seen.y() : seen.x();
      b[k] = steep ? seen.x() : seen.y();
    }
    const Eigen::Vector2d fit = A.colPivHouseholderQr().solve(b);
    const Eigen::Vector2d normal =
        steep ? Eigen::Vector2d(1, -fit[1]) : Eigen::Vector2d(-fit[1], 1);
    lines[i] = Eigen::Hyperplane<double, 2>(normal.normalized(), -fit[0] / normal.norm());
  }
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = lines[i].intersection(lines[(i + 3) % 4]);
  return corners;
}

TEST(Lens, UndistortsWhatItDistorts) {
  for (const auto& camera : kLenses) {
    for (double x = 0; x <= 640; x += 40) {
      for (double y = 0; y <= 480; y += 40) {
        const Eigen::Vector2d seen(x, y);
        EXPECT_LT((distorted(undistorted(seen, camera), camera) - seen).norm(), 1e-9);
      }
    }
  }
}

// The same figures as in the definition of camera_info's model, by hand.
TEST(Lens, FollowsThePlumbBobModel) {
  const CameraIntrinsics camera{100, 100, 0, 0, 640, 480, {0.1, 0.0, 0.01, 0.0, 0.0}};
  const Eigen::Vector2d seen = distorted({30, 40}, camera);
  EXPECT_NEAR(seen.x(), 100 * (0.3 * 1.025 + 2 * 0.01 * 0.12), 1e-12);
  EXPECT_NEAR(seen.y(), 100 * (0.4 * 1.025 + 0.01 * (0.25 + 2 * 0.16)), 1e-12);
}

// An independent implementation of both models.
Eigen::Vector2d by_opencv(const Eigen::Vector2d& ideal, const CameraIntrinsics& camera) {
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const cv::Point2d point((ideal.x() - camera.cx) / camera.fx, (ideal.y() - camera.cy) / camera.fy);
  const std::vector<double> D(camera.distortion.begin(), camera.distortion.end());
  std::vector<cv::Point2d> seen;
  if (camera.lens == LensModel::kEquidistant) {
    cv::fisheye::distortPoints(std::vector<cv::Point2d>{point}, seen, K,
                               std::vector<double>(D.begin(), D.begin() + 4));
  } else {
    cv::projectPoints(std::vector<cv::Point3d>{{point.x, point.y, 1.0}}, cv::Vec3d::zeros(),
                      cv::Vec3d::zeros(), K, D, seen);
  }
  return {seen[0].x, seen[0].y};
}

TEST(Lens, ShowsWhatOpenCvShows) {
  for (const auto& camera : kLenses) {
    for (double x = 0; x <= 640; x += 80) {
      for (double y = 0; y <= 480; y += 80) {
        EXPECT_LT((distorted({x, y}, camera) - by_opencv({x, y}, camera)).norm(), 1e-9);
      }
    }
  }
}

TEST(Lens, SeesNothingBeyondThePinhole) {
  CameraIntrinsics fisheye = camera_with({}, LensModel::kEquidistant);
  fisheye.fx = fisheye.fy = 100;
  const double degree = 100.0 / 180.0 * 3.14159265358979323846;  // px from the centre for each
  EXPECT_TRUE(undistorted({322 + 84 * degree, 238}, fisheye).allFinite());
  EXPECT_FALSE(undistorted({322 + 86 * degree, 238}, fisheye).allFinite());
  EXPECT_EQ(undistorted({322, 238}, fisheye), Eigen::Vector2d(322, 238));
}

TEST(Lens, TakesOffWhatStraightFitsToBentEdgesShift) {
  std::mt19937 random(2);
  double worst_plain = 0.0;
  for (const auto& camera : kLenses) {
    for (int trial = 0; trial < 50; ++trial) {
      const Corners truth = random_square(random);
      const Corners seen = fitted_corners(truth, camera);
      const Corners found = ideal_corners(seen, camera);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_LT((found[i] - truth[i]).norm(), 0.05);
        worst_plain = std::max(worst_plain, (undistorted(seen[i], camera) - truth[i]).norm());
      }
    }
  }
  EXPECT_GT(worst_plain, 0.3) << "the shift is there to be taken off";
}

TEST(Lens, LeavesAnIdealCameraAlone) {
  std::mt19937 random(3);
  const Corners corners = random_square(random);
  EXPECT_EQ(ideal_corners(corners, camera_with({})), corners);
}

}  // namespace
}  // namespace prf_perception
