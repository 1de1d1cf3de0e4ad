// SPDX-License-Identifier: BSD-3-Clause
// Tracks one target through measurements, outliers and gaps, and forecasts it. One TargetPredictor
// has its position, another of the same kind its orientation (rotation_predictor.hpp).
//
// For each image:
//   1. Predict to its stamp. The measurement with the least Mahalanobis distance is tested by the
//      gate, a chi-square bound on that distance. The innovation covariance is widened by
//      (gate_speed * time since the last measurement)^2, for jerks that no motion model predicts.
//   2. A measurement that passes corrects the position, and the orientation where that passes a
//      gate of its own (orientation_track.hpp).
//   3. A measurement outside the gate is an outlier. It starts a candidate target, which replaces
//      the target after `reacquire_hits` consecutive images with a measurement that fits it. There
//      are at most kMostCandidates.
//   4. Without accepted positions the target coasts with growing covariance. After `lost_after` it
//      is lost: its belief stays as it is until a candidate replaces it. Without accepted
//      orientations it counts as coasting and lost, too, though its position goes on.
//
// The states of the last second are kept. An image that comes late is inserted at its stamp, and
// the later ones are computed again. The result depends on stamps alone.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <prf_core/clock_monitor.hpp>
#include <prf_core/forecast.hpp>
#include <vector>

#include "prf_predictor/measured_motion.hpp"
#include "prf_predictor/orientation_track.hpp"
#include "prf_predictor/rotation_predictor.hpp"
#include "prf_predictor/tag_measurement.hpp"
#include "prf_predictor/target_predictor.hpp"

namespace prf_predictor {

using prf_core::Duration;
using prf_core::Stamp;
using prf_core::TargetStatus;

struct TrackerParams {
  double gate_probability = 0.0;        // that a true measurement passes the gate, > 0.5 and < 1
  double gate_speed = 0.0;              // m/s, >= 0
  double orientation_gate_sigma = 0.0;  // rad, >= 0, widens the gate of the orientation
  double orientation_gate_speed = 0.0;  // rad/s, >= 0, the same, times the time since the last one
  int reacquire_hits = 0;               // >= 2
  double coast_after = 0.0;             // s without accepted position or orientation, > 0
  double lost_after = 0.0;              // the same, > coast_after

  // Throws std::invalid_argument naming the parameter, its value and its bound.
  void validate() const;
};

// Shared by copies, never changed.
struct Belief {
  std::shared_ptr<const TargetPredictor> motion;
  std::shared_ptr<const RotationPredictor> rotation;
};

// The track right after one image.
struct TrackState {
  Stamp stamp{0};
  TargetStatus status = TargetStatus::kNoTarget;
  std::optional<Belief> belief;
  Stamp last_accepted{0};  // of the positions
  OrientationTrack orientation;

  struct Candidate {
    Belief belief;
    OrientationTrack orientation;
    Stamp stamp{0};  // of its latest measurement
    int hits = 0;
  };
  std::vector<Candidate> candidates;

  MeasuredMotionWindow measured_motion;  // of the measurement nearest to the target in each image

  bool measured = false;  // a measurement of this image passed the gate
  double nis = 0.0;       // of the nearest measurement's position, accepted or not
  bool gated = false;     // there were measurements, none passed
  bool reacquired = false;
  bool reinitialised = false;  // the belief was no longer finite and was dropped

  // s since the last accepted position, or orientation if that is longer ago.
  [[nodiscard]] double since_accepted() const;
};

// kReplayed: out of order, inserted. kTooOld: older than all states that are kept, dropped.
enum class Arrival { kNewer, kDuplicate, kReplayed, kTooOld, kBackwardJump };

struct TrackerResult {
  Arrival arrival = Arrival::kNewer;
  TrackState state;  // at the image's stamp
};

class TargetTracker {
 public:
  static constexpr Duration kHistory = std::chrono::seconds(1);
  static constexpr std::size_t kMostCandidates = 3;

  // Every track starts from `predictor`, before its begin().
  TargetTracker(const TrackerParams& params, std::shared_ptr<const TargetPredictor> predictor);

  // All measurements of the target in this image, in the planning frame.
  TrackerResult process(Stamp stamp, const std::vector<TagMeasurement>& measurements);

  // At horizons in s; empty without a belief.
  [[nodiscard]] std::vector<prf_core::TargetPrediction> forecast(
      const TrackState& state, const std::vector<double>& horizons) const;

 private:
  struct Entry {
    std::vector<TagMeasurement> measurements;
    TrackState state;
  };
  struct Correction;

  [[nodiscard]] TrackState step(const TrackState& before, Stamp stamp,
                                const std::vector<TagMeasurement>& measurements) const;
  [[nodiscard]] Belief begin(const TagMeasurement& measurement) const;
  // The measurement that corrected the target; null: none passed. `since_measurement`: since the
  // last accepted one, s.
  const TagMeasurement* accept(Correction& target, Stamp stamp,
                               const std::vector<TagMeasurement>& measurements,
                               double since_measurement) const;
  void update_candidates(TrackState& state, const std::vector<TagMeasurement>& measurements) const;
  void update_status(TrackState& state) const;

  TrackerParams params_;
  std::shared_ptr<const TargetPredictor> predictor_;
  double gate_;
  OrientationGate orientation_gate_;
  prf_core::ClockMonitor clock_{{kHistory, Duration::max()}};
  std::deque<Entry> history_;
};

}  // namespace prf_predictor
