// SPDX-License-Identifier: BSD-3-Clause
// Predicts a target on a platform that may move periodically; whether it does, and with which
// frequencies and amplitudes, is found from the measurements.
//
// Candidates are the hypotheses of a filter bank (filter_bank.hpp), an autoregressive model of the
// latest positions (window_predictor.hpp) for repetition that no hypothesis has, an extended filter
// of one oscillation whose frequency it estimates (motion_model.hpp), and standstill. With the
// weights w_i of a horizon (model_weights.hpp) and each candidate's mean m_i and covariance P_i,
// the forecast is the mixture
//   m = sum_i w_i m_i,   P = sum_i w_i (P_i + (m_i - m)(m_i - m)^T),
// whose standard deviations are then calibrated by the errors of past forecasts
// (covariance_calibration.hpp), and made fit for a change of the motion (motion_change.hpp). A
// measurement that shows a change unsettles what was learnt.
#pragma once

#include <deque>
#include <memory>

#include "prf_predictor/forecast_scorer.hpp"
#include "prf_predictor/kalman_predictor.hpp"
#include "prf_predictor/periodic/covariance_calibration.hpp"
#include "prf_predictor/periodic/filter_bank.hpp"
#include "prf_predictor/periodic/model_weights.hpp"
#include "prf_predictor/periodic/motion_change.hpp"
#include "prf_predictor/periodic_params.hpp"
#include "prf_predictor/target_predictor.hpp"
#include "prf_predictor/window_predictor.hpp"

namespace prf_predictor {

class PeriodicPredictor : public TargetPredictor {
 public:
  explicit PeriodicPredictor(const PeriodicParams& params);

  [[nodiscard]] std::unique_ptr<TargetPredictor> clone() const override;
  void begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override;
  void advance(double dt) override;
  void correct(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override;
  [[nodiscard]] PointForecast forecast(double horizon) const override;
  [[nodiscard]] std::optional<Periodicity> periodicity(double horizon) const override;

 private:
  // Whether this measurement shows that the motion is another one, before the filters have it.
  [[nodiscard]] bool shows_change(const Eigen::Vector3d& position,
                                  const Eigen::Matrix3d& covariance);
  // What was learnt of the motion is as uncertain as at first.
  void unsettle(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance);
  // Weights, samples and predictions after the filters have had the measurement.
  void after_measurement(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance);
  void record_predictions();
  // Before calibration; `transitions` are those over the horizon.
  [[nodiscard]] PointForecast mixture(double horizon,
                                      const FilterBank::Transitions& transitions) const;
  // By one of the candidates beside the hypotheses.
  [[nodiscard]] SpectralBelief::Forecast other(Eigen::Index which, double horizon) const;

  PeriodicParams params_;
  FilterBank filters_;
  ModelWeights weights_;
  CovarianceCalibration calibration_;
  MotionChange change_;
  ForecastScorer scorer_;  // of the hypotheses, then the others
  Autoregressive autoregressive_;
  KalmanPredictor oscillation_;
  std::deque<Sample> samples_;
  std::shared_ptr<const Continuation> autoregression_;  // fitted to the samples
  double time_ = 0.0;                                   // s since begin()
  double since_measurement_ = 0.0;                      // s
};

}  // namespace prf_predictor
