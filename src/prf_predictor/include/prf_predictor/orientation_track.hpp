// SPDX-License-Identifier: BSD-3-Clause
// Which measured orientations a track believes. The position of the same measurement has passed its
// own gate before.
//
//   1. A flat tag seen from afar has two poses that explain its corners almost as well. Of a
//      measurement whose ambiguity a is above kClear both orientations are looked at, and the one
//      nearer to the track is taken: the other is a pose flip.
//   2. The gate bounds the Mahalanobis distance by chi-square. The innovation covariance is widened
//      by sigma^2 + (speed * time since the last accepted orientation)^2.
//   3. An orientation outside the gate, or one whose alternative was taken, starts a candidate. It
//      replaces the track's orientation when measurements in a row that fit it have gathered
//      evidence of `reacquire_hits`. One measurement is evidence of
//        w = 1 without an ambiguity above kClear, else (ln a / ln kClear)^2,
//      so a clear turn is followed after `reacquire_hits` images, a flip of a = 0.8 after fifty
//      times as many, and one of a = 1 never.
#pragma once

#include <memory>
#include <optional>
#include <prf_core/time.hpp>

#include "prf_predictor/rotation_predictor.hpp"
#include "prf_predictor/tag_measurement.hpp"

namespace prf_predictor {

struct OrientationGate {
  static constexpr double kClear = 0.2;  // ambiguity up to which a pose is the only one

  double chi_square = 0.0;
  double sigma = 0.0;        // rad
  double speed = 0.0;        // rad/s
  double evidence = 0.0;     // of a candidate that replaces the track
  double longest_gap = 0.0;  // s between two measurements of a candidate
};

struct OrientationCandidate {
  std::shared_ptr<const RotationPredictor> rotation;
  prf_core::Stamp stamp{0};  // of its latest measurement
  double evidence = 0.0;
};

// A track's orientation right after one image.
struct OrientationTrack {
  prf_core::Stamp last_accepted{0};
  std::optional<OrientationCandidate> candidate;

  // Of the latest measurement.
  double nis = 0.0;          // of the nearer orientation, accepted or not
  bool gated = false;        // none passed
  bool alternative = false;  // the second pose was taken
  bool reacquired = false;
};

// Corrects `rotation`, which is already at the stamp, by the measurement, or puts the candidate in
// its place. `prototype`: what new candidates start from.
[[nodiscard]] OrientationTrack follow_orientation(const OrientationTrack& before,
                                                  std::unique_ptr<RotationPredictor>& rotation,
                                                  const TargetPredictor& prototype,
                                                  const TagMeasurement& measurement,
                                                  prf_core::Stamp stamp,
                                                  const OrientationGate& gate);

}  // namespace prf_predictor
