// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/measured_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace prf_predictor {

using prf_core::MeasuredMotion;
using prf_core::Stamp;
using prf_core::to_seconds;

void MeasuredMotionWindow::add(Stamp stamp, const Eigen::Vector3d& position,
                               const Eigen::Matrix3d& covariance, bool is_accepted) {
  samples_.push_back({stamp, position, covariance, is_accepted});
  while (samples_.size() > kLatest && to_seconds(stamp - samples_.front().stamp) > kLongest) {
    samples_.pop_front();
  }
}

bool MeasuredMotionWindow::counts(std::size_t sample) const {
  const Sample& own = samples_[sample];
  if (own.is_accepted || sample == 0) return true;
  const Sample& before = samples_[sample - 1];
  const double d = to_seconds(own.stamp - before.stamp);
  if ((own.position - before.position).norm() <= kFastest * d) return true;
  // Rejected ones among the four that end with it or with one of the next three.
  const std::size_t first = sample < kLatest ? 0 : sample + 1 - kLatest;
  const std::size_t last = std::min(samples_.size(), sample + kLatest);
  return std::count_if(samples_.begin() + static_cast<std::ptrdiff_t>(first),
                       samples_.begin() + static_cast<std::ptrdiff_t>(last),
                       [](const Sample& s) { return !s.is_accepted; }) > 1;
}

MeasuredMotion MeasuredMotionWindow::at(Stamp stamp) const {
  MeasuredMotion motion;
  double sum = 0.0;
  double time = 0.0;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!counts(i)) continue;
    const Sample& later = samples_[i];
    if (before && to_seconds(later.stamp - samples_[*before].stamp) < kShortest) continue;
    if (before) {
      const Sample& earlier = samples_[*before];
      const double d = to_seconds(later.stamp - earlier.stamp);
      const Eigen::Vector3d v = (later.position - earlier.position) / d;
      const Eigen::Matrix3d P = (later.covariance + earlier.covariance) / (d * d);
      if (d <= kLongest && later.stamp == stamp) {
        motion.velocity = v;
        motion.velocity_covariance = P;
      }
      if (d <= kLongest && to_seconds(stamp - later.stamp) < kWindow) {
        sum += d * (v.squaredNorm() - P.trace());
        time += d;
      }
    }
    before = i;
  }
  if (sum > 0) motion.speed = std::sqrt(sum / time);
  return motion;
}

}  // namespace prf_predictor
