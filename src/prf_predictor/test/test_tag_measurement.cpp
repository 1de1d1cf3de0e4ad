// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/tag_measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace prf_predictor {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
constexpr MeasurementDefaults kDefaults{0.002, 0.02};
const Eigen::Vector3d kPosition(0.1, 0.2, 0.3);
const Eigen::Quaterniond kOrientation(0.5, 0.5, -0.5, 0.5);

TEST(TagMeasurement, KeepsAGoodCovariance) {
  Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  covariance(0, 0) = 3e-6;
  const auto checked = check(kPosition, kOrientation, covariance, kDefaults);
  ASSERT_EQ(checked.status, MeasurementStatus::kGood);
  EXPECT_EQ(checked.measurement->position_covariance(0, 0), 3e-6);
}

// Fault 3, 43: a covariance that is zero, no covariance or absurd -> the configured one is used
TEST(TagMeasurement, ReplacesACovarianceThatIsNone) {
  Matrix6d asymmetric = Matrix6d::Identity();
  asymmetric(0, 1) = 0.5;
  Matrix6d indefinite = Matrix6d::Identity();
  indefinite(2, 2) = -1e-6;
  Matrix6d not_finite = Matrix6d::Identity();
  not_finite(4, 4) = std::numeric_limits<double>::infinity();
  const Matrix6d zero = Matrix6d::Zero();
  const Matrix6d huge = 1e300 * Matrix6d::Identity();
  const Matrix6d tiny = 1e-300 * Matrix6d::Identity();
  for (const Matrix6d& bad : {zero, asymmetric, indefinite, not_finite, huge, tiny}) {
    const auto checked = check(kPosition, kOrientation, bad, kDefaults);
    ASSERT_EQ(checked.status, MeasurementStatus::kCovarianceReplaced);
    EXPECT_NEAR(checked.measurement->position_covariance(1, 1), 4e-6, 1e-18);
    EXPECT_NEAR(checked.measurement->orientation_covariance(1, 1), 4e-4, 1e-18);
  }
}

// Fault 1: NaN or infinity in a measurement -> dropped
TEST(TagMeasurement, DropsWhatIsNotFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto position = check({0, bad, 0}, kOrientation, Matrix6d::Identity(), kDefaults);
    EXPECT_EQ(position.status, MeasurementStatus::kNotFinite);
    EXPECT_FALSE(position.measurement);
    const auto orientation = check(kPosition, {bad, 0, 0, 0}, Matrix6d::Identity(), kDefaults);
    EXPECT_EQ(orientation.status, MeasurementStatus::kNotFinite);
  }
}

// Fault 2: a quaternion of norm 0 or far from 1 -> dropped; near 1 -> normalised
TEST(TagMeasurement, DropsAQuaternionFarFromUnitAndNormalisesOneNearIt) {
  for (const double scale : {0.0, 0.5, 2.0}) {
    Eigen::Quaterniond scaled = kOrientation;
    scaled.coeffs() *= scale;
    const auto checked = check(kPosition, scaled, Matrix6d::Identity(), kDefaults);
    EXPECT_EQ(checked.status, MeasurementStatus::kNoOrientation);
    EXPECT_FALSE(checked.measurement);
  }
  Eigen::Quaterniond near = kOrientation;
  near.coeffs() *= 1.005;
  const auto checked = check(kPosition, near, Matrix6d::Identity(), kDefaults);
  ASSERT_TRUE(checked.measurement);
  EXPECT_NEAR(checked.measurement->orientation.norm(), 1.0, 1e-15);
}

// Fault 43: a tag absurdly far away -> dropped
TEST(TagMeasurement, DropsWhatIsTooFarAway) {
  for (const double far : {1e300, -1e300, 1e5, 1e3 + 1}) {
    const auto checked = check({0, far, 0}, kOrientation, Matrix6d::Identity(), kDefaults);
    EXPECT_EQ(checked.status, MeasurementStatus::kTooFar) << far;
    EXPECT_FALSE(checked.measurement);
  }
}

// Fault 18, 43: a second pose without an ambiguity within 0 .. 1, or that is none -> there is none
TEST(TagMeasurement, TakesASecondPoseOnlyWhenItIsOne) {
  TagMeasurement measurement;
  for (const double bad : {0.0, -0.1, 1.1, std::nan(""), 1e300}) {
    EXPECT_FALSE(with_alternative(measurement, kOrientation, bad).alternative) << bad;
  }
  EXPECT_FALSE(with_alternative(measurement, {0, 0, 0, 0}, 0.5).alternative);
  EXPECT_FALSE(with_alternative(measurement, {std::nan(""), 0, 0, 1}, 0.5).alternative);
  EXPECT_TRUE(with_alternative(measurement, kOrientation, 0.5).alternative);
}

TEST(TagMeasurement, TurnsItsCovarianceWithTheFrame) {
  TagMeasurement measurement;
  measurement.position = {0, 0, 1};
  measurement.position_covariance = Eigen::Vector3d(1, 2, 3).asDiagonal();
  measurement.orientation_covariance = Eigen::Vector3d(4, 5, 6).asDiagonal();
  Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();  // looks along x, its x is -y
  camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.translation() << 1, 0, 0;
  const TagMeasurement moved = camera * measurement;
  EXPECT_TRUE(moved.position.isApprox(Eigen::Vector3d(2, 0, 0)));
  EXPECT_TRUE(moved.position_covariance.diagonal().isApprox(Eigen::Vector3d(3, 1, 2)));
  EXPECT_TRUE(moved.orientation_covariance.diagonal().isApprox(Eigen::Vector3d(6, 4, 5)));
  EXPECT_TRUE(moved.orientation.toRotationMatrix().isApprox(camera.linear()));
}

}  // namespace
}  // namespace prf_predictor
