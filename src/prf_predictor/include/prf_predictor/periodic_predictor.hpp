// SPDX-License-Identifier: BSD-3-Clause
// Foretells a target on a platform that may move periodically, without knowing whether it does,
// how fast and how far.
//
// A bank of linear Kalman filters, one for each hypothesis about the frequencies: one frequency and
// its double, or two frequencies, from a geometric grid over [slowest, fastest]; amplitudes and
// phases of each axis are states. All of them also carry a slow drift, a wander and the band of
// the robot's steps, or, in a second set of hypotheses, little of that. Beside them stand the
// hypotheses that nothing is periodic: velocities that decay soon, later and never, and a target at
// rest; and an autoregressive model of the latest positions, for what repeats otherwise.
//
// What is trusted is decided apart for every horizon, by how well each hypothesis i has foretold
// that horizon lately. With the mean squared error e_i over the last `memory` seconds, that
// evidence lasting T and being worth n = T / tau independent looks at three axes (errors tau apart
// are taken as independent), the probability that an unknown error variance leaves to i is
//   w_i ~ prior_i * e_i^(-3 n / 2).
// The forecast is the mixture's mean, its covariance the mixture's, enlarged or shrunk along each
// axis by how the errors of the forecasts given out compare with what was promised.
#pragma once

#include <memory>
#include <vector>

#include "prf_predictor/forecast_ledger.hpp"
#include "prf_predictor/spectral_model.hpp"
#include "prf_predictor/target_predictor.hpp"
#include "prf_predictor/window_predictor.hpp"

namespace prf_predictor {

struct PeriodicParams {
  double slowest = 0.0;       // rad/s, > 0
  double fastest = 0.0;       // rad/s, > slowest
  double step_slowest = 0.0;  // band of the robot's own steps, rad/s, > 0
  double step_fastest = 0.0;  // rad/s, > step_slowest
  double memory = 0.0;        // s, > 0
};

// Throws std::invalid_argument naming the parameter, its value and its bound.
void validate(const PeriodicParams& params);

class PeriodicPredictor : public TargetPredictor {
 public:
  explicit PeriodicPredictor(const PeriodicParams& params);

  [[nodiscard]] std::unique_ptr<TargetPredictor> clone() const override;
  void begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override;
  void advance(double dt) override;
  void correct(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override;
  [[nodiscard]] PointForecast forecast(double horizon) const override;

  // The probability at a horizon that the motion is periodic, and the frequencies of the most
  // probable such hypothesis, rad/s.
  struct Rhythm {
    double probability = 0.0;
    std::vector<double> frequencies;
  };
  [[nodiscard]] Rhythm rhythm(double horizon) const;

 private:
  struct Hypothesis {
    std::size_t parts = 0;  // which of Bank::parts
    std::shared_ptr<const std::vector<int>> used;
    std::vector<double> frequencies;  // none: not periodic
    double prior = 0.0;
  };
  struct Surroundings;
  struct Bank {
    PeriodicParams params;
    Autoregressive autoregressive{10.0, 24};
    std::vector<Parts> parts;
    std::vector<Hypothesis> hypotheses;

    void add_periodic(const Surroundings& surroundings);
  };
  using Transitions = std::vector<std::vector<Transition>>;

  [[nodiscard]] static std::shared_ptr<const Bank> make_bank(const PeriodicParams& params);
  [[nodiscard]] Transitions transitions(double dt) const;
  [[nodiscard]] Eigen::ArrayXd weights(double horizon) const;
  // Of the forecast, given the variance that the filters promise, by how promises proved.
  [[nodiscard]] Eigen::Array3d proven_sigma(double horizon, const Eigen::Array3d& variance) const;
  // Covariance as the filters have it; `passing`: the transitions over the horizon.
  [[nodiscard]] PointForecast mixture(double horizon, const Transitions& passing) const;
  [[nodiscard]] SpectralBelief::Forecast autoregression(double horizon) const;
  void look(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance);
  void settle_weights(double noise_variance);
  void promise();

  std::shared_ptr<const Bank> bank_;
  std::vector<SpectralBelief> beliefs_;  // of each hypothesis
  std::deque<Sample> samples_;
  std::shared_ptr<const Continuation> autoregression_;
  // Candidates: the hypotheses, then the autoregressive model.
  ForecastLedger ledger_;
  std::vector<Eigen::ArrayXd> weights_;  // at each of the ledger's horizons
  std::array<Eigen::Array3d, ForecastLedger::kHorizons.size()> promised_;  // variance, the same
  Eigen::Vector3d noise_ = Eigen::Vector3d::Zero();  // variance of the latest sight
  double time_ = 0.0;                                // s since begin()
  double since_ = 0.0;                               // s since the last sight
  // Variance of innovations less the measurement's over what was promised, faded.
  Eigen::Array3d innovation_excess_ = Eigen::Array3d::Ones();
};

}  // namespace prf_predictor
