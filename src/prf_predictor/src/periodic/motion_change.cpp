// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic/motion_change.hpp"

#include <algorithm>
#include <cmath>

namespace prf_predictor {
namespace {

constexpr double kShortest = 0.005;  // s; the noise of nearer measurements hides the velocity

}  // namespace

void MotionChange::begin(const Eigen::Vector3d& position) {
  *this = MotionChange();
  position_ = mean_ = position;
}

void MotionChange::observe(const Eigen::Vector3d& position, const Eigen::Vector3d& noise,
                           double elapsed) {
  if (elapsed > kShortest) {
    const double share = 1 - std::exp(-elapsed / kMemory);
    const Eigen::Array3d velocity = (position - position_) / elapsed;
    const Eigen::Array3d of_noise = 2 * noise.array() / (elapsed * elapsed);
    speed2_ += share * (velocity.square() - of_noise - speed2_);
    mean_ += share * (position - mean_);
    spread2_ += share * ((position - mean_).array().square() - spread2_);
  }
  position_ = position;
}

bool MotionChange::is_shown_by(const ObservedError& error) { return error.ratio() > kSurprise; }

Eigen::Array3d MotionChange::least_variance(double age) const {
  const Eigen::Array3d before =
      (age * age * speed2_.max(0.0)).min(2 * spread2_).max(std::pow(kLeastSpeed * age, 2));
  return kShare * kShare * before;
}

}  // namespace prf_predictor
