// SPDX-License-Identifier: BSD-3-Clause
// What holds for every predictor, by its name and with the parameters of its file.
#include "prf_predictor/predictors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include "predictor_files.hpp"

namespace prf_predictor {
namespace {

constexpr double kFrame = 1.0 / 30;
const Eigen::Matrix3d kNoise = Eigen::Vector3d(4e-8, 1e-8, 1e-8).asDiagonal();

std::unique_ptr<TargetPredictor> predictor(const std::string& name) {
  return make_predictor(name, values_of(name));
}

Eigen::Vector3d position_at(double t) {
  return {0.8 + 0.06 * std::sin(2.4 * t), 0.02 * std::sin(2.4 * t + 1) + 0.008 * std::sin(8.6 * t),
          0.3 + 0.05 * std::cos(2.4 * t)};
}

// Measures the target from `start` to `end`, with an image missing now and then.
void follow(TargetPredictor& predictor, double start, double end) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0, 1e-4);
  for (int frame = 0; start + frame * kFrame < end; ++frame) {
    const double t = start + frame * kFrame;
    const Eigen::Vector3d measured =
        position_at(t) + Eigen::Vector3d::NullaryExpr([&](Eigen::Index) { return normal(random); });
    if (frame == 0 && start == 0) {
      predictor.begin(measured, kNoise);
      continue;
    }
    predictor.advance(kFrame);
    if (frame % 9 != 5) predictor.correct(measured, kNoise);
  }
}

class EveryPredictor : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryPredictor, ForecastsFinitelyWithAPositiveDefiniteCovariance) {
  const auto target = predictor(GetParam());
  target->begin(position_at(0), kNoise);
  for (int second = 0; second < 6; ++second) {
    for (const double horizon : {0.0, 0.04, 0.5, 2.0, 10.0}) {
      const PointForecast forecast = target->forecast(horizon);
      ASSERT_TRUE(is_finite(forecast)) << horizon;
      ASSERT_EQ(forecast.covariance, forecast.covariance.transpose());
      ASSERT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(forecast.covariance)
                    .eigenvalues()
                    .minCoeff(),
                0);
    }
    follow(*target, second, second + 1);
  }
}

// The measurement noise is 0.17 mm, and the target moves by 4 mm a frame: a filter that lags by a
// tenth of a frame misses the bound.
TEST_P(EveryPredictor, KnowsWhereTheTargetIsNow) {
  const auto target = predictor(GetParam());
  follow(*target, 0, 6);
  double squared = 0.0;
  constexpr int kFrames = 60;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double t = 6 + frame * kFrame;
    target->advance(kFrame);
    target->correct(position_at(t) + 1e-4 * Eigen::Vector3d(std::sin(9.0 * frame), 1, -1), kNoise);
    squared += (target->forecast(0).position - position_at(t)).squaredNorm();
  }
  EXPECT_LT(std::sqrt(squared / kFrames), 2.5e-4);
}

TEST_P(EveryPredictor, IsUnchangedByWhatItsCloneSees) {
  const auto target = predictor(GetParam());
  follow(*target, 0, 4);
  const PointForecast before = target->forecast(0.5);
  const auto clone = target->clone();
  EXPECT_EQ(clone->forecast(0.5).position, before.position);
  follow(*clone, 4, 8);
  EXPECT_NE(clone->forecast(0.5).position, before.position);
  EXPECT_EQ(target->forecast(0.5).position, before.position);
  EXPECT_EQ(target->forecast(0.5).covariance, before.covariance);
}

TEST_P(EveryPredictor, IsLessCertainOfTheFartherFutureAndAfterAGap) {
  const auto target = predictor(GetParam());
  follow(*target, 0, 6);
  const auto trace = [&](double horizon) {
    return target->forecast(horizon).covariance.topLeftCorner<3, 3>().trace();
  };
  EXPECT_LT(trace(0), trace(0.1));
  EXPECT_LT(trace(0.1), trace(0.5));
  const double before = trace(0);
  target->advance(0.5);
  EXPECT_LT(before, trace(0));
}

TEST_P(EveryPredictor, BeginsAnewWithoutMemory) {
  const auto used = predictor(GetParam());
  const auto fresh = predictor(GetParam());
  follow(*used, 0, 4);
  follow(*used, 0, 3);
  follow(*fresh, 0, 3);
  EXPECT_EQ(used->forecast(0.5).position, fresh->forecast(0.5).position);
  EXPECT_EQ(used->forecast(0.5).covariance, fresh->forecast(0.5).covariance);
}

// Fault 28, 52: a predictor's parameter missing, NaN, 5e-324 or 1e308 -> refused by its name
TEST_P(EveryPredictor, RefusesParametersThatAreMissingUnknownOrOutOfBounds) {
  const auto good = values_of(GetParam());
  auto unknown = good;
  unknown["no_such_parameter"] = 1;
  EXPECT_THROW((void)make_predictor(GetParam(), unknown), std::invalid_argument);
  for (const auto& [key, value] : good) {
    for (const double bad : {-1.0, 0.0, std::nan(""), 5e-324, 1e308}) {
      auto values = good;
      values[key] = bad;
      try {
        (void)make_predictor(GetParam(), values);
        ADD_FAILURE() << key << " = " << bad << " was accepted";
      } catch (const std::invalid_argument& error) {
        EXPECT_EQ(std::string(error.what()).rfind(key + " = ", 0), 0u) << error.what();
      }
    }
    auto missing = good;
    missing.erase(key);
    EXPECT_THROW((void)make_predictor(GetParam(), missing), std::invalid_argument);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryPredictor, ::testing::ValuesIn(predictor_names()),
                         [](const auto& test) { return test.param; });

TEST(Predictors, HaveOneFileEachInTheConfiguration) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(CONFIG "/predictors")) {
    files.insert(entry.path().filename());
    EXPECT_EQ(YAML::LoadFile(entry.path())["predictor"].as<std::string>(), entry.path().stem());
  }
  std::set<std::string> expected;
  for (const std::string& name : predictor_names()) expected.insert(name + ".yaml");
  EXPECT_EQ(files, expected);
}

TEST(Predictors, RefuseAnUnknownName) {
  EXPECT_THROW((void)make_predictor("magic", {}), std::invalid_argument);
}

}  // namespace
}  // namespace prf_predictor
