// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic_predictor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <random>

#include "prf_predictor/kalman_predictor.hpp"

namespace prf_predictor {
namespace {

using Path = std::function<Eigen::Vector3d(double)>;
constexpr double kFrame = 1.0 / 30;
const Eigen::Matrix3d kNoise = 9e-8 * Eigen::Matrix3d::Identity();

PeriodicPredictor periodic() { return PeriodicPredictor({1.2, 3.8, 5.0, 12.0, 6.0}); }

KalmanPredictor constant_velocity() {
  return {std::make_shared<DecayingVelocity>(
              VelocityDecay{0.03, std::numeric_limits<double>::infinity()}),
          SigmaPointParams::paper()};
}

struct Figures {
  double rms = 0.0;   // m, 0.5 s ahead
  double nees = 0.0;  // the same
};

// Over [from, to] s after the first sight.
Figures follow(TargetPredictor& predictor, const Path& path, double from, double to) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 3e-4);
  Figures figures;
  int count = 0;
  for (int frame = 0; frame * kFrame < to; ++frame) {
    const double t = frame * kFrame;
    const Eigen::Vector3d seen =
        path(t) + Eigen::Vector3d::NullaryExpr([&](Eigen::Index) { return normal(random); });
    if (frame == 0) predictor.begin(seen, kNoise);
    if (frame > 0) predictor.advance(kFrame);
    if (frame > 0) predictor.correct(seen, kNoise);
    if (t < from) continue;
    const PointForecast forecast = predictor.forecast(0.5);
    const Eigen::Vector3d error = forecast.position - path(t + 0.5);
    const Eigen::Matrix3d P = forecast.covariance.topLeftCorner<3, 3>();
    figures.rms += error.squaredNorm();
    figures.nees += error.dot(P.inverse() * error);
    ++count;
  }
  figures.rms = std::sqrt(figures.rms / count);
  figures.nees /= count;
  return figures;
}

// Lines as measured on the real robot in heavy and in light motion while it steps.
Eigen::Vector3d heavy(double t) {
  return {0.061 * std::sin(2.4 * t) + 0.007 * std::sin(4.8 * t + 1) + 0.002 * std::sin(8.6 * t),
          0.018 * std::sin(2.4 * t + 2) + 0.009 * std::sin(8.6 * t + 1),
          0.05 * std::sin(2.4 * t + 0.7) + 0.002 * std::sin(17.2 * t)};
}

Eigen::Vector3d light(double t) {
  return {0.018 * std::sin(2.0 * t) + 0.016 * std::sin(1.5 * t + 1),
          0.026 * std::sin(2.0 * t + 2) + 0.007 * std::sin(8.4 * t),
          0.015 * std::sin(1.5 * t + 0.5)};
}

TEST(PeriodicPredictor, HalvesTheErrorWithinTwoPeriods) {
  for (const Path& path : {Path(heavy), Path(light)}) {
    auto ours = periodic();
    auto paper = constant_velocity();
    EXPECT_LT(follow(ours, path, 5.2, 8).rms, 0.5 * follow(paper, path, 5.2, 8).rms);
  }
}

TEST(PeriodicPredictor, NamesTheFrequencyAndKnowsThatItIsThere) {
  for (const double frequency : {1.5, 2.4, 3.1}) {
    auto target = periodic();
    follow(
        target, [&](double t) { return Eigen::Vector3d(0.05 * std::sin(frequency * t), 0, 0); }, 11,
        12);
    const auto rhythm = target.rhythm(1.0);
    double nearest = 1.0;
    for (const double W : rhythm.frequencies) {
      nearest = std::min(nearest, std::abs(W / frequency - 1));
    }
    EXPECT_LT(nearest, 0.08) << frequency;
  }
}

TEST(PeriodicPredictor, IsNoWorseThanConstantVelocityWhereNothingIsPeriodic) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  std::vector<Eigen::Vector3d> walk{Eigen::Vector3d::Zero()};
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3000; ++k) {  // 100 Hz, pushed at random
    velocity += 0.01 * (-velocity + 2.0 * Eigen::Vector3d::NullaryExpr(
                                              [&](Eigen::Index) { return normal(random); }));
    walk.push_back(walk.back() + 0.01 * velocity);
  }
  const Path path = [&](double t) { return walk[static_cast<std::size_t>(std::lround(100 * t))]; };
  auto ours = periodic();
  auto paper = constant_velocity();
  EXPECT_LT(follow(ours, path, 3, 25).rms, 1.05 * follow(paper, path, 3, 25).rms);
}

TEST(PeriodicPredictor, PromisesWhatItKeeps) {
  for (const Path& path : {Path(heavy), Path(light)}) {
    auto target = periodic();
    const double nees = follow(target, path, 5, 20).nees;
    EXPECT_GT(nees, 1.0);
    EXPECT_LT(nees, 6.0);
  }
}

TEST(PeriodicPredictor, RefusesBandsThatAreNone) {
  for (const PeriodicParams& bad : {PeriodicParams{0, 3.8, 5, 12, 6},
                                    {1.2, 1.0, 5, 12, 6},
                                    {1.2, 3.8, NAN, 12, 6},
                                    {1.2, 3.8, 5, 4, 6},
                                    {1.2, 3.8, 5, 12, 0}}) {
    EXPECT_THROW(PeriodicPredictor{bad}, std::invalid_argument);
  }
}

TEST(SpectralBelief, KeepsAPositiveDefiniteCovarianceForLong) {
  const Parts parts{{1e-4, 0.3}, {{2.4, 0.002, 0.06}, {4.8, 0.002, 0.01}}};
  SpectralBelief belief(parts, std::make_shared<std::vector<int>>(std::vector<int>{0, 1, 2}),
                        Eigen::Vector3d::Zero(), 1e-8);
  const auto passing = parts.transitions(kFrame);
  for (int k = 0; k < 20000; ++k) {
    belief.advance(passing);
    belief.correct(Eigen::Vector3d::Constant(0.05 * std::sin(2.4 * k * kFrame)), 1e-8);
  }
  EXPECT_GT(
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(belief.covariance()).eigenvalues().minCoeff(),
      0);
}

TEST(Resonance, TransitionsComposeOverTime) {
  for (const double damping : {0.002, 0.3, 0.9}) {
    const Transition once = transition(Resonance{2.4, damping, 0.06}, 0.2);
    const Transition twice = transition(Resonance{2.4, damping, 0.06}, 0.4);
    EXPECT_LT((twice.F - once.F * once.F).norm(), 1e-13);
    EXPECT_LT((twice.Q - once.F * once.Q * once.F.transpose() - once.Q).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace prf_predictor

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
