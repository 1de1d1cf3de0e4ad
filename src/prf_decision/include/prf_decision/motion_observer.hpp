// SPDX-License-Identifier: BSD-3-Clause
// What the HMM observes of a forecast. A filter that expects smooth motion averages a shaking
// target away, so its velocity v alone does not tell how fast the target is. The forecast brings
// the velocity z between the latest two images, too, with the covariance R of its noise:
//   hidden_k^2 = kChord^2 (|z_k - v_k|^2 - kNoise tr R_k)   what the filter does not show at image
//   k spread^2   = max(0, second largest hidden_k^2 of the last kHeld, |z|^2 - tr R - |v|^2)
// Between two images a shaking target covers less than at its peak velocity: of a sine that is
// sin(a) / a, a = pi f T, down to 1 / kChord at half the image rate. Hidden motion is
// held, because such a target is slow for an image or two at each turn, and the HMM needs some
// images to be sure; the second largest, because a filter that learns a change may be off in one
// image. The last term makes the observation at least as fast as what was measured.
// Where the filter follows, little is hidden, and a regular motion may be fast.
#pragma once

#include <chrono>
#include <cmath>
#include <deque>
#include <optional>

#include "prf_decision/hmm.hpp"
#include "prf_decision/types.hpp"

namespace prf_decision {

class MotionObserver {
 public:
  static constexpr Duration kHeld = std::chrono::milliseconds(250);
  // The largest of eight squares of pure noise stays below about this many times their mean.
  static constexpr double kNoise = 5.0;

  static constexpr double kChord = M_PI / 2;

  // None: the target was not measured. Stamps rise. The result is finite for any numbers.
  [[nodiscard]] std::optional<ObservedMotion> observe(const TargetForecast& forecast);

 private:
  struct Hidden {
    Stamp stamp{0};
    double square = 0;  // (m/s)^2
  };

  std::deque<Hidden> hidden_;  // of the last kHeld, squares above 0
};

}  // namespace prf_decision
