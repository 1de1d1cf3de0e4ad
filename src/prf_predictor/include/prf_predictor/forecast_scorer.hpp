// SPDX-License-Identifier: BSD-3-Clause
// Compares past predictions with the measurements that came due: which of several candidate models
// predicts best at each horizon, and how large the real errors are beside the predicted covariance.
//
// A prediction made at t for the horizon h is due at t + h. Its error e is the difference to the
// measured position, interpolated to t + h between two measurements by the parabola through the
// latest three, whatever the rate of the images. With d_j the time that
// prediction j stands for (since the one before it) and m the memory, sums over all that are due,
//   T   = sum_j d_j exp(-(now - due_j) / m)                        evidence, s
//   E_i = 1 / T sum_j d_j exp(-(now - due_j) / m) |e_ij|^2         of candidate i
//   L_i = the same mean of ln(|e_ij|^2 + sum of r_j)               of candidate i
//   G   = the same mean of (e_j^2 - r_j) / p_j, for each axis      covariance inflation
// with r the variance of the measurement and p the predicted variance.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <deque>
#include <memory>

#include "prf_predictor/periodic/motion_change.hpp"

namespace prf_predictor {

class ForecastScorer {
 public:
  static constexpr std::array<double, 5> kHorizons{0.1, 0.25, 0.5, 1.0, 2.0};  // s
  // Errors of predictions that are so far apart in time count as independent, s.
  static constexpr std::array<double, kHorizons.size()> kIndependent{0.3, 0.5, 0.7, 1.0, 1.5};

  static constexpr double kShort = 0.3;  // s

  // For one horizon.
  struct Prediction {
    Eigen::Matrix3Xd candidates;                         // position by each candidate, m
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // that the predictor published, m
    Eigen::Vector3d variance = Eigen::Vector3d::Zero();  // predicted, of each axis, m^2
    Eigen::Array3d calibrated = Eigen::Array3d::Zero();  // the same, as past errors say
  };
  using Predictions = std::array<Prediction, kHorizons.size()>;

  explicit ForecastScorer(Eigen::Index candidates);

  // A measurement: the predictions that have come due are scored. `memory`: m, s.
  void observe(double time, const Eigen::Vector3d& position, const Eigen::Vector3d& variance,
               double memory);
  // Predictions from `time`, after observe() of the same time.
  void record(double time, Predictions predictions);

  // The motion is another one: past errors tell nothing about it, nor will those of predictions
  // that were made before.
  void forget();

  // T, s.
  [[nodiscard]] double evidence(std::size_t horizon) const { return sums_[horizon].evidence; }
  // L of every candidate; 0 without evidence.
  [[nodiscard]] Eigen::ArrayXd log_error(std::size_t horizon) const;
  // E, m^2; 0 without evidence.
  [[nodiscard]] double squared_error(std::size_t horizon, Eigen::Index candidate) const;
  // G, times (n + 3) / (n + 1) for n = T / kIndependent errors, because a variance estimated from
  // few errors is uncertain. Starts at 1. Negative when the errors are below the measurement noise.
  [[nodiscard]] Eigen::Array3d inflation(std::size_t horizon) const;
  // The most surprising error of the short predictions (kShort) that came due between the latest
  // two measurements; none when these are too far apart to tell where the target was between them.
  [[nodiscard]] const ObservedError& worst() const { return worst_; }

 private:
  struct Entry {
    double time = 0.0;
    double duration = 0.0;  // s since the entry before
    Predictions predictions;
  };
  struct Sums {
    double evidence = 0.0;
    Eigen::ArrayXd squared_error;
    Eigen::ArrayXd log_error;
    Eigen::Array3d inflation = Eigen::Array3d::Zero();
    double scored_until = 0.0;  // predictions made until then are scored or never will be
  };

  [[nodiscard]] Eigen::Vector3d curvature(double time, const Eigen::Vector3d& position) const;

  double usual_interval_ = 0.0;  // s, between measurements
  ObservedError worst_;
  double earlier_time_ = -1.0;  // of the measurement before the latest
  Eigen::Vector3d earlier_position_ = Eigen::Vector3d::Zero();
  bool has_measurement_ = false;
  double measured_time_ = -1.0;
  Eigen::Vector3d measured_position_ = Eigen::Vector3d::Zero();
  std::deque<std::shared_ptr<const Entry>> entries_;
  std::array<Sums, kHorizons.size()> sums_;
};

// The place of a horizon between two of the scorer's: a fraction of the way from the lower to the
// upper one. Beyond the first and the last it is the nearest one.
struct BetweenHorizons {
  std::size_t lower = 0;
  std::size_t upper = 0;
  double fraction = 0.0;
};

[[nodiscard]] BetweenHorizons between_horizons(double horizon);

}  // namespace prf_predictor
