// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic_predictor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <prf_core/require.hpp>

namespace prf_predictor {

using prf_core::require;
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFrequencies = 12;
constexpr int kStepBands = 5;
constexpr double kPlatformSwing = 0.06;  // m, standard deviation before anything is known
constexpr double kStepSwing = 0.015;     // m, of the whole band
constexpr double kStepPurity = 0.07;     // damping ratio

// Not periodic: the constant-velocity model, velocities that decay, and rest.
const std::vector<VelocityDecay> kAperiodic{
    {0.3, kInfinity}, {0.3, 0.6}, {0.3, 0.3}, {3e-3, 0.6}, {3e-4, 0.3}};
constexpr double kPeriodicPrior = 0.4;
constexpr double kAperiodicPrior = 0.3;
constexpr double kAutoregressivePrior = 0.3;
constexpr double kInnovationMemory = 3.0;  // s
constexpr double kLeastOfNoise = 0.4;      // no forecast is surer than this part of the sights
constexpr double kLeastExcess = 1e-4;      // of a variance that proves to be too large

// n values from first to last, neighbours at equal ratios.
std::vector<double> geometric(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(first * std::pow(last / first, static_cast<double>(i) / (count - 1)));
  }
  return values;
}

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

// What goes on beside the periodic motion, and how pure that is.
struct PeriodicPredictor::Surroundings {
  VelocityDecay drift;
  std::vector<Resonance> wander;
  double purity = 0.0;  // damping ratio
  bool steps = false;
};

void validate(const PeriodicParams& params) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  require(positive(params.slowest), "slowest", params.slowest, "finite and > 0 rad/s");
  require(params.fastest > params.slowest && std::isfinite(params.fastest), "fastest",
          params.fastest, "finite and > slowest");
  require(positive(params.step_slowest), "step_slowest", params.step_slowest,
          "finite and > 0 rad/s");
  require(params.step_fastest > params.step_slowest && std::isfinite(params.step_fastest),
          "step_fastest", params.step_fastest, "finite and > step_slowest");
  require(positive(params.memory), "memory", params.memory, "finite and > 0 s");
}

void PeriodicPredictor::Bank::add_periodic(const Surroundings& surroundings) {
  // Parts: 0 the drift, then wander and steps, the platform's frequencies, and their doubles.
  Parts all{surroundings.drift, surroundings.wander};
  if (surroundings.steps) {
    for (const double W : geometric(params.step_slowest, params.step_fastest, kStepBands)) {
      all.resonances.push_back({W, kStepPurity, kStepSwing / std::sqrt(kStepBands)});
    }
  }
  std::vector<int> common(all.resonances.size() + 1);
  std::iota(common.begin(), common.end(), 0);
  const auto add = [&](const std::vector<int>& more, std::vector<double> frequencies) {
    std::vector<int> used = common;
    used.insert(used.end(), more.begin(), more.end());
    hypotheses.push_back({parts.size(), std::make_shared<std::vector<int>>(std::move(used)),
                          std::move(frequencies), 0.0});
  };

  const auto frequencies = geometric(params.slowest, params.fastest, kFrequencies);
  const int first = static_cast<int>(common.size());
  for (const double multiple : {1.0, 2.0}) {
    const double swing = multiple == 1 ? kPlatformSwing : kPlatformSwing / 6;
    for (const double W : frequencies) {
      all.resonances.push_back({multiple * W, surroundings.purity, swing});
    }
  }
  for (int a = 0; a < kFrequencies; ++a) {
    add({first + a, first + kFrequencies + a}, {frequencies[index(a)]});
    for (int b = a + 1; b < kFrequencies; ++b) {
      add({first + a, first + b}, {frequencies[index(a)], frequencies[index(b)]});
    }
  }
  parts.push_back(std::move(all));
}

std::shared_ptr<const PeriodicPredictor::Bank> PeriodicPredictor::make_bank(
    const PeriodicParams& params) {
  validate(params);
  auto bank = std::make_shared<Bank>();
  bank->params = params;
  bank->add_periodic(
      {{1e-3, 0.3}, {{1.5, 0.9, 0.03}, {17.0, 0.3, 0.003}, {26.0, 0.3, 0.002}}, 0.01, true});
  bank->add_periodic({{1e-4, 0.3}, {{1.5, 0.9, 0.003}}, 0.002, false});
  const std::size_t periodic = bank->hypotheses.size();
  for (const VelocityDecay& decay : kAperiodic) {
    bank->hypotheses.push_back(
        {bank->parts.size(), std::make_shared<std::vector<int>>(1, 0), {}, 0.0});
    bank->parts.push_back({decay, {}});
  }
  for (std::size_t i = 0; i < bank->hypotheses.size(); ++i) {
    const bool is_periodic = i < periodic;
    bank->hypotheses[i].prior = is_periodic
                                    ? kPeriodicPrior / static_cast<double>(periodic)
                                    : kAperiodicPrior / static_cast<double>(kAperiodic.size());
  }
  return bank;
}

PeriodicPredictor::PeriodicPredictor(const PeriodicParams& params)
    : bank_(make_bank(params)),
      ledger_(static_cast<Eigen::Index>(bank_->hypotheses.size()) + 1, params.memory) {}

std::unique_ptr<TargetPredictor> PeriodicPredictor::clone() const {
  return std::make_unique<PeriodicPredictor>(*this);
}

void PeriodicPredictor::begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  beliefs_.clear();
  samples_.clear();
  ledger_ =
      ForecastLedger(static_cast<Eigen::Index>(bank_->hypotheses.size()) + 1, bank_->params.memory);
  time_ = 0.0;
  since_ = 0.0;
  innovation_excess_.setOnes();
  const double variance = covariance.trace() / 3;
  for (const Hypothesis& hypothesis : bank_->hypotheses) {
    beliefs_.emplace_back(bank_->parts[hypothesis.parts], hypothesis.used, position, variance);
  }
  look(position, covariance);
}

// What is remembered of a sight beside the filters.
void PeriodicPredictor::look(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  noise_ = covariance.diagonal();
  samples_.push_back({time_, position});
  while (samples_.front().time < time_ - bank_->autoregressive.window()) samples_.pop_front();
  autoregression_ = bank_->autoregressive.fit(samples_);
  ledger_.observe(time_, position, covariance.diagonal());
  settle_weights(covariance.trace());
  promise();
}

PeriodicPredictor::Transitions PeriodicPredictor::transitions(double dt) const {
  Transitions result;
  for (const Parts& parts : bank_->parts) result.push_back(parts.transitions(dt));
  return result;
}

void PeriodicPredictor::advance(double dt) {
  const Transitions passing = transitions(dt);
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    beliefs_[i].advance(passing[bank_->hypotheses[i].parts]);
  }
  time_ += dt;
  since_ += dt;
}

void PeriodicPredictor::correct(const Eigen::Vector3d& position,
                                const Eigen::Matrix3d& covariance) {
  const PointForecast expected = mixture(0, transitions(0));
  const Eigen::Array3d ratio =
      ((position - expected.position).array().square() - covariance.diagonal().array()) /
      expected.covariance.diagonal().head<3>().array();
  const double share = 1 - std::exp(-since_ / kInnovationMemory);
  innovation_excess_ += share * (ratio - innovation_excess_);
  since_ = 0.0;

  const double variance = covariance.trace() / 3;
  for (SpectralBelief& belief : beliefs_) belief.correct(position, variance);
  look(position, covariance);
}

void PeriodicPredictor::settle_weights(double noise_variance) {
  const auto& hypotheses = bank_->hypotheses;
  weights_.assign(ForecastLedger::kHorizons.size(), {});
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    const ForecastLedger::Score score = ledger_.score(k);
    Eigen::ArrayXd& weight = weights_[k];
    weight.setConstant(static_cast<Eigen::Index>(hypotheses.size()) + 1,
                       std::log(kAutoregressivePrior));
    for (std::size_t i = 0; i < hypotheses.size(); ++i) {
      weight(static_cast<Eigen::Index>(i)) = std::log(hypotheses[i].prior);
    }
    if (score.evidence > 0) {
      weight -= 1.5 * score.evidence / ForecastLedger::kIndependent[k] *
                (score.squared_error + noise_variance).log();
    } else if (k > 0) {
      weight = weights_[k - 1].log();
    }
    weight = (weight - weight.maxCoeff()).exp();
    weight /= weight.sum();
  }
}

void PeriodicPredictor::promise() {
  ForecastLedger::Promises promises;
  for (std::size_t k = 0; k < promises.size(); ++k) {
    const double horizon = ForecastLedger::kHorizons[k];
    const Transitions passing = transitions(horizon);
    auto& candidates = promises[k].candidates;
    candidates.resize(3, static_cast<Eigen::Index>(beliefs_.size()) + 1);
    candidates.rightCols<1>() = autoregression_->position(time_ + horizon);
    for (std::size_t i = 0; i < beliefs_.size(); ++i) {
      candidates.col(static_cast<Eigen::Index>(i)) =
          beliefs_[i].position(passing[bank_->hypotheses[i].parts]);
    }
    const PointForecast given = mixture(horizon, passing);
    promises[k].position = given.position;
    promises[k].variance = given.covariance.diagonal().head<3>();
    promised_[k] = promises[k].variance;
  }
  ledger_.promise(time_, std::move(promises));
}

Eigen::ArrayXd PeriodicPredictor::weights(double horizon) const {
  const BetweenHorizons between = between_horizons(since_ + horizon);
  return (1 - between.fraction) * weights_[between.lower] +
         between.fraction * weights_[between.upper];
}

// As sure as it has proved to be.
SpectralBelief::Forecast PeriodicPredictor::autoregression(double horizon) const {
  constexpr double kStep = 0.01;           // s, for the velocity
  constexpr double kLeastVariance = 1e-8;  // m^2
  constexpr double kShortest = 0.1;        // s over which a velocity is as uncertain as a position
  const double then = time_ + horizon;
  const double age = since_ + horizon;
  SpectralBelief::Forecast forecast;
  forecast.position = autoregression_->position(then);
  forecast.velocity = (autoregression_->position(then + kStep) - forecast.position) / kStep;
  const BetweenHorizons between = between_horizons(age);
  const auto variance = [&](std::size_t k) {
    const ForecastLedger::Score score = ledger_.score(k);
    return score.squared_error(score.squared_error.size() - 1) / 3;
  };
  const double first = ForecastLedger::kHorizons.front();
  const double position = kLeastVariance + std::min(age / first, 1.0) *
                                               ((1 - between.fraction) * variance(between.lower) +
                                                between.fraction * variance(between.upper));
  forecast.covariance =
      Eigen::Vector2d(position, position / std::pow(std::max(age, kShortest), 2)).asDiagonal();
  return forecast;
}

PointForecast PeriodicPredictor::mixture(double horizon, const Transitions& passing) const {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  constexpr double kNegligible = 1e-3;
  const Eigen::ArrayXd weight = weights(horizon);
  double total = 0.0;
  Vector6d mean = Vector6d::Zero();
  Eigen::Matrix2d within = Eigen::Matrix2d::Zero();
  std::vector<std::pair<double, Vector6d>> modes;
  for (std::size_t i = 0; i <= beliefs_.size(); ++i) {
    const double w = weight(static_cast<Eigen::Index>(i));
    if (w < kNegligible) continue;
    const auto one = i < beliefs_.size() ? beliefs_[i].forecast(passing[bank_->hypotheses[i].parts])
                                         : autoregression(horizon);
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

Eigen::Array3d PeriodicPredictor::proven_sigma(double horizon,
                                               const Eigen::Array3d& variance) const {
  const double age = since_ + horizon;
  const auto& all = ForecastLedger::kHorizons;
  const Eigen::Array3d now = innovation_excess_.max(kLeastExcess);
  if (age < all.front()) {
    const Eigen::Array3d soon = ledger_.score(0).excess.max(kLeastExcess);
    return (variance * (now + age / all.front() * (soon - now))).sqrt();
  }
  const BetweenHorizons between = between_horizons(age);
  const auto sigma = [&](std::size_t k) -> Eigen::Array3d {
    const double beyond = age > all.back() ? age / all.back() : 1.0;
    return beyond * (promised_[k] * ledger_.score(k).excess.max(kLeastExcess)).sqrt();
  };
  return sigma(between.lower) + between.fraction * (sigma(between.upper) - sigma(between.lower));
}

PointForecast PeriodicPredictor::forecast(double horizon) const {
  PointForecast forecast = mixture(horizon, transitions(horizon));
  const Eigen::Array3d variance = forecast.covariance.diagonal().head<3>();
  const Eigen::Array3d sigma =
      proven_sigma(horizon, variance).max(kLeastOfNoise * noise_.array().sqrt());
  const Eigen::Array3d scale = sigma / variance.sqrt();
  Eigen::Matrix<double, 6, 1> both;
  both << scale, scale;
  forecast.covariance = repaired(both.asDiagonal() * forecast.covariance * both.asDiagonal());
  return forecast;
}

PeriodicPredictor::Rhythm PeriodicPredictor::rhythm(double horizon) const {
  const Eigen::ArrayXd weight = weights(horizon);
  Rhythm rhythm;
  double best = 0.0;
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    const Hypothesis& hypothesis = bank_->hypotheses[i];
    const double w = weight(static_cast<Eigen::Index>(i));
    if (hypothesis.frequencies.empty()) continue;
    rhythm.probability += w;
    if (w > best) rhythm.frequencies = hypothesis.frequencies;
    best = std::max(best, w);
  }
  return rhythm;
}

}  // namespace prf_predictor
