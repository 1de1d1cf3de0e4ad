// SPDX-License-Identifier: BSD-3-Clause
// Follows one target through sights, ghosts and gaps, and says where it will be: the front end of
// any TargetPredictor, one of which has the position, another one the orientation.
//
// For every image, in this order: predict to its stamp; take the sight nearest to the prediction;
// if its Mahalanobis distance, by the covariance widened by gate_speed, passes the gate, correct
// (the orientation has a gate of its own: a flipped one is dropped, the position kept). A sight
// outside the gate starts a candidate, which replaces the target once `reacquire_hits` sights in a
// row were consistent with it while none passed the gate. Without accepted sights the target coasts
// with growing covariance; beyond `lost_after` it is lost, its belief stands still and only a
// candidate brings it back.
//
// Images may come twice or late: the states of the last second are kept, a late image is put in
// its place and what follows is computed again. The result depends on stamps alone.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "prf_predictor/rotation_predictor.hpp"
#include "prf_predictor/tag_measurement.hpp"
#include "prf_predictor/target_predictor.hpp"

namespace prf_predictor {

using Nanoseconds = std::int64_t;

struct TrackerParams {
  double gate_probability = 0.0;  // that a true sight passes the gate, 0.5 .. 1, both excluded
  double gate_speed = 0.0;        // m/s, >= 0, of jerks that no filter foresees; times the time
                                  // since the last accepted sight it widens the gate
  double orientation_gate_sigma = 0.0;  // rad, the same
  int reacquire_hits = 0;               // >= 2
  double coast_after = 0.0;             // s without accepted sight, > 0
  double lost_after = 0.0;              // the same, > coast_after
};

// Throws std::invalid_argument naming the parameter, its value and its bound.
void validate(const TrackerParams& params);

enum class TrackStatus { kNoTarget, kTracking, kCoasting, kLost };

struct Belief {
  // Never changed once they are here.
  std::shared_ptr<const TargetPredictor> motion;
  std::shared_ptr<const RotationPredictor> rotation;
};

// The track right after one image.
struct TrackState {
  Nanoseconds stamp = 0;
  TrackStatus status = TrackStatus::kNoTarget;
  std::optional<Belief> belief;
  Nanoseconds last_accepted = 0;

  struct Candidate {
    Belief belief;
    Nanoseconds stamp = 0;  // of its latest sight
    int hits = 0;
  };
  std::optional<Candidate> candidate;

  bool measured = false;         // this image gave a sight that passed the gate
  double nis = 0.0;              // of the nearest sight's position, accepted or not
  double orientation_nis = 0.0;  // of the accepted sight's orientation
  bool gated = false;            // sights there were, none passed
  bool orientation_gated = false;
  bool reacquired = false;
  bool reinitialised = false;  // the belief was no longer finite and was dropped
};

enum class Arrival { kInOrder, kDuplicate, kReplayed, kTooOld, kNewRun };

struct Prediction {
  double horizon = 0.0;  // s
  PointForecast point;
  OrientationForecast rotation;
};

class TargetTracker {
 public:
  static constexpr Nanoseconds kHistory = 1'000'000'000;

  // `predictor` is what every track starts from, before its begin().
  TargetTracker(const TrackerParams& params, std::shared_ptr<const TargetPredictor> predictor);

  struct Answer {
    Arrival arrival = Arrival::kInOrder;
    TrackState state;  // at the image's stamp
  };

  // `sights` are all of the target in this image, in the planning frame.
  Answer process(Nanoseconds stamp, const std::vector<TagMeasurement>& sights);

  // Empty when there is no belief.
  [[nodiscard]] std::vector<Prediction> forecast(const TrackState& state,
                                                 const std::vector<double>& horizons) const;

 private:
  struct Entry {
    std::vector<TagMeasurement> sights;
    TrackState state;
  };

  // What a step may still change.
  struct Moving {
    std::unique_ptr<TargetPredictor> motion;
    std::unique_ptr<RotationPredictor> rotation;

    Moving(const Belief& before, double dt);
    [[nodiscard]] bool is_finite() const;
  };

  [[nodiscard]] TrackState step(const TrackState& before, Nanoseconds stamp,
                                const std::vector<TagMeasurement>& sights) const;
  [[nodiscard]] Belief begin(const TagMeasurement& sight) const;
  // unseen: time since the last accepted sight, s.
  bool accept(Moving& target, const std::vector<TagMeasurement>& sights, double unseen,
              TrackState& state) const;
  void pursue_candidate(TrackState& state, const std::vector<TagMeasurement>& sights) const;
  void settle_status(TrackState& state) const;

  TrackerParams params_;
  std::shared_ptr<const TargetPredictor> predictor_;
  double gate_;
  std::deque<Entry> history_;
};

}  // namespace prf_predictor
