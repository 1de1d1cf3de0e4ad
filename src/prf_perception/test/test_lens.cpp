// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/lens.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <random>

namespace prf_perception {
namespace {

CameraIntrinsics camera_with(const std::array<double, 5>& distortion) {
  return {615, 610, 322, 238, 640, 480, distortion};
}

const std::array<CameraIntrinsics, 3> kLenses{camera_with({0.1, -0.2, 0.0008, -0.0006, 0.08}),
                                              camera_with({-0.3, 0.1, 0.002, 0.001, 0.0}),
                                              camera_with({0.2, 0.0, 0.0, 0.0, 0.0})};

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
