// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic_predictor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "prf_predictor/gaussian.hpp"

namespace prf_predictor {
namespace {

constexpr double kVelocityStep = 0.01;   // s, of the difference quotient
constexpr double kLeastVariance = 1e-8;  // m^2, of the candidates that are no hypotheses
constexpr double kShortest = 0.1;        // s, over which a velocity is as uncertain as a position
constexpr double kNegligibleWeight = 1e-3;  // such candidates are left out of a mixture

// Of the one oscillation whose frequency a filter estimates, as in ekf.yaml.
const OscillationNoise kOscillationNoise{0.03, 1e-4, 0.01};

const PeriodicParams& validated(const PeriodicParams& params) {
  params.validate();
  return params;
}

// Beside the hypotheses of the bank.
enum Other : Eigen::Index { kAutoregressive, kOscillation, kStandstill, kOthers };

// The hypotheses, then the others.
Eigen::ArrayXd priors(const FilterBank& filters, double autoregressive) {
  Eigen::ArrayXd prior(static_cast<Eigen::Index>(filters.size()) + kOthers);
  prior.setConstant(autoregressive / kOthers);
  for (std::size_t i = 0; i < filters.size(); ++i) {
    prior(static_cast<Eigen::Index>(i)) = filters.prior(i);
  }
  return prior;
}

}  // namespace

PeriodicPredictor::PeriodicPredictor(const PeriodicParams& params)
    : params_(validated(params)),
      filters_(params),
      weights_(priors(filters_, params.autoregressive_prior)),
      calibration_(params.innovation_memory, params.least_noise_share, params.least_inflation),
      scorer_(static_cast<Eigen::Index>(filters_.size()) + kOthers),
      autoregressive_(params.autoregressive_window, params.autoregressive_order),
      oscillation_(std::make_shared<Oscillation>(kOscillationNoise), std::nullopt) {}

std::unique_ptr<TargetPredictor> PeriodicPredictor::clone() const {
  return std::make_unique<PeriodicPredictor>(*this);
}

void PeriodicPredictor::begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  samples_.clear();
  autoregression_.reset();
  scorer_ = ForecastScorer(static_cast<Eigen::Index>(filters_.size()) + kOthers);
  calibration_ = CovarianceCalibration(params_.innovation_memory, params_.least_noise_share,
                                       params_.least_inflation);
  time_ = 0.0;
  since_measurement_ = 0.0;
  filters_.begin(position, covariance.trace() / 3);
  oscillation_.begin(position, covariance);
  change_.begin(position);
  scorer_.observe(time_, position, covariance.diagonal(), params_.memory);
  after_measurement(position, covariance);
}

void PeriodicPredictor::advance(double dt) {
  filters_.advance(dt);
  oscillation_.advance(dt);
  time_ += dt;
  since_measurement_ += dt;
}

void PeriodicPredictor::correct(const Eigen::Vector3d& position,
                                const Eigen::Matrix3d& covariance) {
  scorer_.observe(time_, position, covariance.diagonal(), params_.memory);
  if (shows_change(position, covariance)) unsettle(position, covariance);
  change_.observe(position, covariance.diagonal(), since_measurement_);
  since_measurement_ = 0.0;
  filters_.correct(position, covariance.trace() / 3);
  oscillation_.correct(position, covariance);
  after_measurement(position, covariance);
}

bool PeriodicPredictor::shows_change(const Eigen::Vector3d& position,
                                     const Eigen::Matrix3d& covariance) {
  const PointForecast expected = mixture(0, *filters_.transitions(0));
  const Eigen::Vector3d variance = expected.covariance.diagonal().head<3>();
  const Eigen::Vector3d innovation = position - expected.position;
  const ObservedError error{innovation.array().square(),
                            calibration_.sigma(since_measurement_, variance, scorer_).square() +
                                covariance.diagonal().array()};
  calibration_.observe(innovation, covariance.diagonal(), variance, since_measurement_);
  return MotionChange::is_shown_by(error) || MotionChange::is_shown_by(scorer_.worst());
}

void PeriodicPredictor::unsettle(const Eigen::Vector3d& position,
                                 const Eigen::Matrix3d& covariance) {
  filters_.unsettle(covariance.trace() / 3);
  oscillation_.begin(position, covariance);
  scorer_.forget();
  calibration_ = CovarianceCalibration(params_.innovation_memory, params_.least_noise_share,
                                       params_.least_inflation);
}

void PeriodicPredictor::after_measurement(const Eigen::Vector3d& position,
                                          const Eigen::Matrix3d& covariance) {
  calibration_.set_noise(covariance.diagonal());
  samples_.push_back({time_, position});
  while (samples_.front().time < time_ - autoregressive_.window()) samples_.pop_front();
  autoregression_ = autoregressive_.fit(samples_, autoregression_.get());
  weights_.update(scorer_);
  record_predictions();
}

void PeriodicPredictor::record_predictions() {
  ForecastScorer::Predictions predictions;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const double horizon = ForecastScorer::kHorizons[k];
    const auto shared = filters_.transitions(horizon);
    const FilterBank::Transitions& transitions = *shared;
    auto& candidates = predictions[k].candidates;
    const auto first = static_cast<Eigen::Index>(filters_.size());
    candidates.resize(3, first + kOthers);
    candidates.col(first + kAutoregressive) = autoregression_->position(time_ + horizon);
    candidates.col(first + kOscillation) = oscillation_.position(horizon);
    candidates.col(first + kStandstill) = samples_.back().position;
    for (std::size_t i = 0; i < filters_.size(); ++i) {
      candidates.col(static_cast<Eigen::Index>(i)) = filters_.position(i, transitions);
    }
    const PointForecast published = mixture(horizon, transitions);
    predictions[k].position = published.position;
    predictions[k].variance = published.covariance.diagonal().head<3>();
    calibration_.set_predicted(k, predictions[k].variance);
    predictions[k].calibrated =
        calibration_.sigma(horizon, predictions[k].variance, scorer_).square();
  }
  scorer_.record(time_, std::move(predictions));
}

// Its variance is the mean squared error of its past predictions.
SpectralBelief::Forecast PeriodicPredictor::other(Eigen::Index which, double horizon) const {
  const double age = since_measurement_ + horizon;
  SpectralBelief::Forecast forecast;
  const auto position = [&](double ahead) -> Eigen::Vector3d {
    if (which == kStandstill) return samples_.back().position;
    return which == kOscillation ? oscillation_.position(ahead)
                                 : autoregression_->position(time_ + ahead);
  };
  forecast.position = position(horizon);
  forecast.velocity = (position(horizon + kVelocityStep) - forecast.position) / kVelocityStep;
  const auto row = static_cast<Eigen::Index>(filters_.size()) + which;
  const BetweenHorizons between = between_horizons(age);
  const auto variance_at = [&](std::size_t k) { return scorer_.squared_error(k, row) / 3; };
  const double first = ForecastScorer::kHorizons.front();
  const double variance =
      kLeastVariance +
      std::min(age / first, 1.0) * ((1 - between.fraction) * variance_at(between.lower) +
                                    between.fraction * variance_at(between.upper));
  forecast.covariance =
      Eigen::Vector2d(variance, variance / std::pow(std::max(age, kShortest), 2)).asDiagonal();
  return forecast;
}

PointForecast PeriodicPredictor::mixture(double horizon,
                                         const FilterBank::Transitions& transitions) const {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  const Eigen::ArrayXd weight = weights_.at(since_measurement_ + horizon);
  double total = 0.0;
  Vector6d mean = Vector6d::Zero();
  Eigen::Matrix2d within = Eigen::Matrix2d::Zero();
  std::vector<std::pair<double, Vector6d>> modes;
  for (std::size_t i = 0; i < filters_.size() + kOthers; ++i) {
    const double w = weight(static_cast<Eigen::Index>(i));
    if (w < kNegligibleWeight) continue;
    const auto one = i < filters_.size()
                         ? filters_.forecast(i, transitions)
                         : other(static_cast<Eigen::Index>(i - filters_.size()), horizon);
    Vector6d mode;
    mode << one.position, one.velocity;
    modes.emplace_back(w, mode);
    total += w;
    mean += w * mode;
    within += w * one.covariance;
  }
  mean /= total;
  Eigen::Matrix<double, 6, 6> covariance = for_three_axes(within);
  for (const auto& [w, mode] : modes) covariance += w * (mode - mean) * (mode - mean).transpose();
  return {mean.head<3>(), mean.tail<3>(), covariance / total};
}

PointForecast PeriodicPredictor::forecast(double horizon) const {
  PointForecast forecast = mixture(horizon, *filters_.transitions(horizon));
  const double age = since_measurement_ + horizon;
  const Eigen::Array3d variance = forecast.covariance.diagonal().head<3>();
  const Eigen::Array3d calibrated = calibration_.sigma(age, variance, scorer_).square();
  const Eigen::Array3d scale = (calibrated.max(change_.least_variance(age)) / variance).sqrt();
  Eigen::Matrix<double, 6, 1> both;
  both << scale, scale;
  forecast.covariance = repaired(both.asDiagonal() * forecast.covariance * both.asDiagonal());
  return forecast;
}

std::optional<Periodicity> PeriodicPredictor::periodicity(double horizon) const {
  const Eigen::ArrayXd weight = weights_.at(since_measurement_ + horizon);
  Periodicity result;
  double best = 0.0;
  double total = weight(static_cast<Eigen::Index>(filters_.size()) + kStandstill);
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    const double w = weight(static_cast<Eigen::Index>(i));
    total += w;
    if (filters_.frequencies(i).empty()) continue;
    result.probability += w;
    if (w > best) result.frequencies = filters_.frequencies(i);
    best = std::max(best, w);
  }
  result.probability = total > 0 ? result.probability / total : 0.0;
  const auto oscillation = static_cast<Eigen::Index>(filters_.size()) + kOscillation;
  if (weight(oscillation) > best) {
    result.frequencies = {std::exp(oscillation_.belief().mean(Oscillation::kLogFrequency))};
  }
  return result;
}

}  // namespace prf_predictor
