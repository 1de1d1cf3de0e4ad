// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/pinhole_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace camera_sim {
namespace {

PinholeCamera with_distortion(const std::array<double, 5>& distortion) {
  PinholeCamera camera;
  camera.distortion = distortion;
  return camera;
}

constexpr std::array<double, 5> kMild{0.1, -0.2, 0.0008, -0.0006, 0.08};
constexpr std::array<double, 5> kBarrel{-0.3, 0.09, 0.001, 0.002, 0.0};

TEST(PinholeCamera, SeesAnIdealPointWhereThePinholeDoes) {
  const PinholeCamera camera;
  EXPECT_TRUE(camera.to_pixel({0.1, -0.2}).isApprox(Eigen::Vector2d(381.5, 117.0)));
  EXPECT_FALSE(camera.distorts());
}

// Worked out by hand from the equations for k1 = 0.1, p1 = 0.01 at (0.3, 0.4): r^2 = 0.25.
TEST(PinholeCamera, DistortsByTheModelOfCameraInfo) {
  const PinholeCamera camera = with_distortion({0.1, 0.0, 0.01, 0.0, 0.0});
  const Eigen::Vector2d seen = camera.distort({0.3, 0.4});
  EXPECT_NEAR(seen.x(), 0.3 * 1.025 + 2.0 * 0.01 * 0.12, 1e-15);
  EXPECT_NEAR(seen.y(), 0.4 * 1.025 + 0.01 * (0.25 + 2.0 * 0.16), 1e-15);
}

TEST(PinholeCamera, FindsTheLineOfSightOfEveryPixel) {
  for (const auto& distortion : {kMild, kBarrel}) {
    const PinholeCamera camera = with_distortion(distortion);
    ASSERT_NO_THROW(camera.validate());
    for (double x = -10.0; x <= 650.0; x += 33.0) {
      for (double y = -10.0; y <= 490.0; y += 25.0) {
        const Eigen::Vector2d pixel(x, y);
        EXPECT_LT((camera.to_pixel(camera.to_normalised(pixel)) - pixel).norm(), 1e-9);
      }
    }
  }
}

TEST(PinholeCamera, KnowsTheDerivativeOfItsDistortion) {
  const PinholeCamera camera = with_distortion(kBarrel);
  constexpr double kStep = 1e-6;
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.3, -0.2), Eigen::Vector2d(-0.5, 0.4)}) {
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(i);
      const Eigen::Vector2d slope =
          (camera.distort(at + step) - camera.distort(at - step)) / (2.0 * kStep);
      EXPECT_LT((camera.distortion_jacobian(at).col(i) - slope).norm(), 1e-8);
    }
  }
}

TEST(PinholeCamera, RefusesALensThatFoldsTheImage) {
  EXPECT_THROW(with_distortion({-1.0, 0.0, 0.0, 0.0, 0.0}).validate(), std::invalid_argument);
  EXPECT_THROW(with_distortion({0.0, -3.0, 0.0, 0.0, 0.0}).validate(), std::invalid_argument);
  EXPECT_THROW(with_distortion({0.0, 0.0, 0.5, 0.0, 0.0}).validate(), std::invalid_argument);
  EXPECT_THROW(with_distortion({std::nan(""), 0.0, 0.0, 0.0, 0.0}).validate(),
               std::invalid_argument);
}

// Fault 44, 52: focal length or axis that no camera has -> refused, at once
TEST(PinholeCamera, RefusesNumbersThatNoCameraHas) {
  ASSERT_NO_THROW(PinholeCamera().validate());
  for (double PinholeCamera::*const field :
       {&PinholeCamera::fx, &PinholeCamera::fy, &PinholeCamera::cx, &PinholeCamera::cy}) {
    for (const double value : {std::nan(""), 1e308, -1e308, 1e9, -1e9}) {
      PinholeCamera camera = with_distortion(kMild);
      camera.*field = value;
      EXPECT_THROW(camera.validate(), std::invalid_argument) << value;
    }
  }
  for (const double value : {5e-324, 1e-6, 0.0, -615.0}) {
    PinholeCamera camera = with_distortion(kMild);
    camera.fx = value;
    EXPECT_THROW(camera.validate(), std::invalid_argument) << value;
  }
}

}  // namespace
}  // namespace camera_sim
