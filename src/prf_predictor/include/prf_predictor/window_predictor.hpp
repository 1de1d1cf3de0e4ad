// SPDX-License-Identifier: BSD-3-Clause
// Predictors that fit a curve to the measured positions of the last seconds and extrapolate it.
// Their covariance comes from the errors of their own past predictions (ForecastScorer).
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "prf_predictor/forecast_scorer.hpp"
#include "prf_predictor/target_predictor.hpp"

namespace prf_predictor {

struct Sample {
  double time = 0.0;  // s
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

// A curve fitted to past samples, at any time.
class Continuation {
 public:
  virtual ~Continuation() = default;
  [[nodiscard]] virtual Eigen::Vector3d position(double time) const = 0;
};

// How to fit. There is at least one sample; their times rise.
class Extrapolation {
 public:
  virtual ~Extrapolation() = default;
  [[nodiscard]] virtual double window() const = 0;  // s of samples that it uses
  // `before`: what was fitted before the latest sample came; null: nothing. Not all of a fit need
  // be made anew.
  [[nodiscard]] virtual std::shared_ptr<const Continuation> fit(
      const std::deque<Sample>& samples, const Continuation* before) const = 0;
};

// Stays at the last position.
class Hold : public Extrapolation {
 public:
  [[nodiscard]] double window() const override { return 0.0; }
  [[nodiscard]] std::shared_ptr<const Continuation> fit(const std::deque<Sample>& samples,
                                                        const Continuation* before) const override;
};

// x_k = m + sum_i a_i (x_{k-i} - m) of each axis, on a grid of 1/15 s, fitted by regularised least
// squares to the window and iterated. The coefficients of one axis after the other are fitted anew,
// one for each sample.
class Autoregressive : public Extrapolation {
 public:
  Autoregressive(double window, double order);  // s, > 0; lags, a whole number 1 .. 60

  [[nodiscard]] double window() const override { return window_; }
  [[nodiscard]] std::shared_ptr<const Continuation> fit(const std::deque<Sample>& samples,
                                                        const Continuation* before) const override;

 private:
  double window_;
  int order_;
};

// x(t) = m + sum_k c_k cos(W_k t) + s_k sin(W_k t): the frequencies, common to
// the axes, are found one after the other as peaks of the residual's periodogram and refined by
// least squares.
class Sines : public Extrapolation {
 public:
  Sines(double window, double count);  // s, > 0; a whole number 1 .. 8

  [[nodiscard]] double window() const override { return window_; }
  [[nodiscard]] std::shared_ptr<const Continuation> fit(const std::deque<Sample>& samples,
                                                        const Continuation* before) const override;

 private:
  double window_;
  int count_;
};

class WindowPredictor : public TargetPredictor {
 public:
  explicit WindowPredictor(std::shared_ptr<const Extrapolation> extrapolation);

  [[nodiscard]] std::unique_ptr<TargetPredictor> clone() const override;
  void begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override;
  void advance(double dt) override;
  void correct(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override;
  [[nodiscard]] PointForecast forecast(double horizon) const override;

 private:
  std::shared_ptr<const Extrapolation> extrapolation_;
  std::deque<Sample> samples_;
  std::shared_ptr<const Continuation> path_;
  ForecastScorer scorer_{1};
  Eigen::Matrix3d noise_ = Eigen::Matrix3d::Zero();  // of the latest measurement
  double time_ = 0.0;                                // s since begin()
};

}  // namespace prf_predictor
