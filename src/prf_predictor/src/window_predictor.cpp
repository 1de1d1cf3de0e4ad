// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/window_predictor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <prf_core/require.hpp>
#include "prf_predictor/gaussian.hpp"

namespace prf_predictor {

using prf_core::require;
namespace {

constexpr double kSpeed =
    0.2;  // m/s, error per horizon that is predicted before any prediction came due
constexpr double kLeastSigma = 1e-4;  // m
constexpr double kMemory = 6.0;       // s, of past errors

class Standstill : public Continuation {
 public:
  explicit Standstill(const Eigen::Vector3d& position) : position_(position) {}
  [[nodiscard]] Eigen::Vector3d position(double /*time*/) const override { return position_; }

 private:
  Eigen::Vector3d position_;
};

}  // namespace

std::shared_ptr<const Continuation> Hold::fit(const std::deque<Sample>& samples,
                                              const Continuation* /*before*/) const {
  return std::make_shared<Standstill>(samples.back().position);
}

WindowPredictor::WindowPredictor(std::shared_ptr<const Extrapolation> extrapolation)
    : extrapolation_(std::move(extrapolation)) {
  require(extrapolation_ != nullptr, "extrapolation", "null", "given");
}

std::unique_ptr<TargetPredictor> WindowPredictor::clone() const {
  return std::make_unique<WindowPredictor>(*this);
}

void WindowPredictor::begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  *this = WindowPredictor(extrapolation_);
  correct(position, covariance);
}

void WindowPredictor::advance(double dt) { time_ += dt; }

void WindowPredictor::correct(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  samples_.push_back({time_, position});
  while (samples_.front().time < time_ - extrapolation_->window()) samples_.pop_front();
  path_ = extrapolation_->fit(samples_, path_.get());
  noise_ = covariance;
  scorer_.observe(time_, position, covariance.diagonal(), kMemory);
  ForecastScorer::Predictions predictions;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const double horizon = ForecastScorer::kHorizons[k];
    predictions[k].position = path_->position(time_ + horizon);
    predictions[k].candidates = predictions[k].position;
    predictions[k].variance.setConstant(std::pow(kSpeed * horizon, 2));
  }
  scorer_.record(time_, std::move(predictions));
}

PointForecast WindowPredictor::forecast(double horizon) const {
  const double age = time_ - samples_.back().time + horizon;
  const double then = time_ + horizon;
  constexpr double kStep = 0.01;  // s, for the velocity
  PointForecast forecast;
  forecast.position = path_->position(then);
  forecast.velocity = (path_->position(then + kStep) - forecast.position) / kStep;

  // The standard deviation is linear between the scorer's horizons.
  const BetweenHorizons between = between_horizons(age);
  const auto sigma = [&](std::size_t k) -> Eigen::Array3d {
    const Eigen::Array3d inflation = scorer_.inflation(k).max(0.0).sqrt();
    return kSpeed * ForecastScorer::kHorizons[k] * inflation;
  };
  const auto& all = ForecastScorer::kHorizons;
  const double beyond = age / std::clamp(age, all.front(), all.back());
  const Eigen::Array3d deviation =
      kLeastSigma + beyond * (sigma(between.lower) +
                              between.fraction * (sigma(between.upper) - sigma(between.lower)));
  forecast.covariance.topLeftCorner<3, 3>() = noise_;
  forecast.covariance.diagonal().head<3>().array() += deviation.square();
  forecast.covariance.diagonal().tail<3>().array() = (deviation / std::max(age, 0.1)).square();
  return forecast;
}

}  // namespace prf_predictor
