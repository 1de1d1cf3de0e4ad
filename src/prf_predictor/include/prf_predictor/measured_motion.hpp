// SPDX-License-Identifier: BSD-3-Clause
// How fast the target moves by its latest measured positions alone. A filter that expects smooth
// motion averages a shaking target away, and a gate rejects what is far off; these figures do
// neither. With measurements p_i, p_j of covariances R_i, R_j, d seconds apart,
//   v = (p_i - p_j) / d,   P_v = (R_i + R_j) / d^2,
//   speed^2 = mean of |v|^2 - tr P_v over the pairs of neighbours in the last kWindow.
//
// A measurement outside the gate that is farther from its predecessor than kFastest allows counts
// only when another of its neighbours was outside, too: one alone is an outlier.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <prf_core/forecast.hpp>

namespace prf_predictor {

class MeasuredMotionWindow {
 public:
  static constexpr double kWindow = 0.25;    // s
  static constexpr double kLongest = 0.6;    // s between two measurements of a pair
  static constexpr double kShortest = 0.01;  // s; the noise of nearer ones hides the velocity
  static constexpr double kFastest = 5.0;    // m/s, of a target
  static constexpr int kLatest = 4;          // neighbours that are looked at

  // Stamps rise.
  void add(prf_core::Stamp stamp, const Eigen::Vector3d& position,
           const Eigen::Matrix3d& covariance, bool is_accepted);

  // At the stamp of an image. It has a velocity when this image had a measurement that counts.
  [[nodiscard]] prf_core::MeasuredMotion at(prf_core::Stamp stamp) const;

 private:
  struct Sample {
    prf_core::Stamp stamp{0};
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    bool is_accepted = false;
  };

  [[nodiscard]] bool counts(std::size_t sample) const;

  std::deque<Sample> samples_;
};

}  // namespace prf_predictor
