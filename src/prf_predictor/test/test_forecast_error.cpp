// SPDX-License-Identifier: BSD-3-Clause
// What the default noise is chosen by: the error of the forecast on motion like that of the tag in
// the arm's base, sway of 0.05 .. 0.1 m at 2.0 .. 2.4 rad/s plus the gait's small lines, seen at
// 30 Hz with noise of 0.3 .. 1 mm. Run with --gtest_also_run_disabled_tests for the table.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "prf_predictor/kalman_predictor.hpp"
#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {
namespace {

constexpr VelocityDecay kDefault{0.03, 0.6};  // as in config/target_predictor.yaml
const std::vector<double> kHorizons{0.1, 0.25, 0.5, 1.0};

struct Sway {
  double amplitude;  // m
  double frequency;  // rad/s
  double noise;      // m
};

Eigen::Vector3d position_at(double t, const Sway& sway) {
  const double phase = sway.frequency * t;
  const Eigen::Vector3d swaying =
      sway.amplitude *
      Eigen::Vector3d(0.3 * std::sin(phase + 1.0), std::sin(phase), 0.5 * std::sin(phase + 0.75));
  const Eigen::Vector3d stepping(0.001 * std::sin(8.6 * t),
                                 0.0045 * std::sin(8.6 * t + 0.5) + 0.015 * std::sin(1.1 * t),
                                 0.0005 * std::sin(17.2 * t));
  return Eigen::Vector3d(0.8, 0.0, 0.3) + swaying + (sway.amplitude > 0 ? 1.0 : 0.0) * stepping;
}

struct ForecastError {
  std::vector<double> rms;    // m, of each horizon
  std::vector<double> sigma;  // m, what the covariance promised
  double mean_nis = 0;
};

ForecastError measure(const VelocityDecay& motion, const std::vector<Sway>& sways) {
  TrackerParams params{{0.03, 0.6}, 0.9999, 0.005, 5, 0.15, 2.0};
  ForecastError error{std::vector<double>(kHorizons.size()), std::vector<double>(kHorizons.size()),
                      0};
  int count = 0;
  for (const Sway& sway : sways) {
    TargetTracker tracker(
        params, std::make_shared<KalmanPredictor>(std::make_shared<DecayingVelocity>(motion),
                                                  SigmaPointParams::textbook()));
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, sway.noise);
    for (int frame = 0; frame < 900; ++frame) {
      const double t = std::round(frame * 1000 / 30.0) / 1000;  // exposures on a grid of 1 ms
      TagMeasurement sight;
      sight.position = position_at(t, sway);
      for (int axis = 0; axis < 3; ++axis) sight.position[axis] += normal(random);
      sight.position_covariance =
          std::pow(std::max(sway.noise, 3e-4), 2) * Eigen::Matrix3d::Identity();
      sight.orientation_covariance = 1e-5 * Eigen::Matrix3d::Identity();
      const auto state = tracker.process(std::llround(t * 1e9), {sight}).state;
      if (frame < 60) continue;
      ++count;
      error.mean_nis += state.nis;
      const auto forecast = tracker.forecast(state, kHorizons);
      for (std::size_t i = 0; i < kHorizons.size(); ++i) {
        error.rms[i] +=
            (forecast[i].point.position - position_at(t + kHorizons[i], sway)).squaredNorm();
        error.sigma[i] += forecast[i].point.covariance.topLeftCorner<3, 3>().trace();
      }
    }
  }
  for (double& value : error.rms) value = std::sqrt(value / count);
  for (double& value : error.sigma) value = std::sqrt(value / count);
  error.mean_nis /= count;
  return error;
}

const std::vector<Sway> kSwaying{
    {0.05, 2.0, 3e-4}, {0.05, 2.4, 7e-4}, {0.1, 2.4, 1e-3}, {0.1, 2.0, 3e-4}};
const std::vector<Sway> kStill{{0.0, 0.0, 5e-4}};

TEST(ForecastError, IsSmallForASwayingTarget) {
  const auto error = measure(kDefault, kSwaying);
  EXPECT_LT(error.rms[0], 0.005);
  EXPECT_LT(error.rms[1], 0.017);
  EXPECT_LT(error.rms[2], 0.046);
  EXPECT_LT(error.rms[3], 0.115);
}

TEST(ForecastError, IsWhatTheCovariancePromises) {
  const auto error = measure(kDefault, kSwaying);
  for (std::size_t i = 0; i < kHorizons.size(); ++i) {
    EXPECT_GT(error.sigma[i], 0.8 * error.rms[i]) << kHorizons[i];
    EXPECT_LT(error.sigma[i], 2.0 * error.rms[i]) << kHorizons[i];
  }
  EXPECT_LT(error.mean_nis, 3.0);
}

TEST(ForecastError, IsSmallForATargetAtRest) { EXPECT_LT(measure(kDefault, kStill).rms[2], 0.01); }

TEST(ForecastError, DISABLED_TableOverTheNoise) {
  std::printf(
      "T s      q      rms mm at 0.1  0.25   0.5    1 s | promised          | NIS  | still\n");
  for (const double T : {std::numeric_limits<double>::infinity(), 2.0, 1.0, 0.6, 0.4}) {
    for (const double q : {0.003, 0.01, 0.03, 0.1, 0.3, 1.0}) {
      const auto swaying = measure({q, T}, kSwaying);
      const auto still = measure({q, T}, kStill);
      std::printf("%-7.3g %6.3f %15.1f %6.1f %6.1f %6.1f |%5.1f %5.1f %5.1f %6.1f | %4.2f | %.1f\n",
                  T, q, 1e3 * swaying.rms[0], 1e3 * swaying.rms[1], 1e3 * swaying.rms[2],
                  1e3 * swaying.rms[3], 1e3 * swaying.sigma[0], 1e3 * swaying.sigma[1],
                  1e3 * swaying.sigma[2], 1e3 * swaying.sigma[3], swaying.mean_nis,
                  1e3 * still.rms[2]);
    }
  }
}

}  // namespace
}  // namespace prf_predictor

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
