// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/target_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/chi_square.hpp>
#include <prf_core/require.hpp>
#include <prf_core/se3.hpp>
#include <utility>

#include "prf_predictor/gaussian.hpp"

namespace prf_predictor {

using prf_core::require;
using prf_core::require_between;
using prf_core::to_seconds;

namespace {

struct Nearest {
  const TagMeasurement* measurement = nullptr;
  double nis = 0.0;
  double distance = std::numeric_limits<double>::infinity();  // as nis, by the widened covariance
};

double squared_distance(const Eigen::Vector3d& residual, const Eigen::Matrix3d& covariance) {
  return residual.dot(repaired(covariance).llt().solve(residual));
}

// By the Mahalanobis distance to where the target is expected now.
Nearest nearest_to(const TargetPredictor& target, const std::vector<TagMeasurement>& measurements,
                   double widening) {
  const PointForecast expected = target.forecast(0);
  Nearest nearest;
  for (const TagMeasurement& measurement : measurements) {
    const Eigen::Vector3d residual = measurement.position - expected.position;
    const Eigen::Matrix3d S =
        expected.covariance.topLeftCorner<3, 3>() + measurement.position_covariance;
    const Eigen::Matrix3d widened = S + std::pow(widening, 2) * Eigen::Matrix3d::Identity();
    const double distance = squared_distance(residual, widened);
    if (distance < nearest.distance)
      nearest = {&measurement, squared_distance(residual, S), distance};
  }
  return nearest;
}

}  // namespace

void TrackerParams::validate() const {
  require(gate_probability > 0.5 && gate_probability <= 0.999999999, "gate_probability",
          gate_probability, "> 0.5 and <= 0.999999999");
  require_between("gate_speed", gate_speed, 0, 10, "m/s");
  require_between("orientation_gate_sigma", orientation_gate_sigma, 0, 1, "rad");
  require_between("orientation_gate_speed", orientation_gate_speed, 0, 10, "rad/s");
  require(reacquire_hits >= 2 && reacquire_hits <= 1000, "reacquire_hits", reacquire_hits,
          "2 .. 1000");
  require_between("coast_after", coast_after, 0.01, 60, "s");
  require(lost_after > coast_after && lost_after <= 3600, "lost_after", lost_after,
          "> coast_after and <= 3600 s");
}

double TrackState::since_accepted() const {
  return to_seconds(stamp - std::min(last_accepted, orientation.last_accepted));
}

TargetTracker::TargetTracker(const TrackerParams& params,
                             std::shared_ptr<const TargetPredictor> predictor)
    : params_(params), predictor_(std::move(predictor)) {
  params_.validate();
  require(predictor_ != nullptr, "predictor", "null", "given");
  gate_ = prf_core::chi_square_quantile(3, params.gate_probability);
  orientation_gate_ = {gate_, params.orientation_gate_sigma, params.orientation_gate_speed,
                       static_cast<double>(params.reacquire_hits), params.lost_after};
}

// A belief at a new time, which a measurement may still change.
struct TargetTracker::Correction {
  std::unique_ptr<TargetPredictor> motion;
  std::unique_ptr<RotationPredictor> rotation;
  OrientationTrack orientation;

  Correction(const Belief& before, const OrientationTrack& track, double dt)
      : motion(before.motion->clone()),
        rotation(std::make_unique<RotationPredictor>(*before.rotation)),
        orientation{track.last_accepted, track.candidate} {
    motion->advance(dt);
    rotation->advance(dt);
  }

  [[nodiscard]] bool is_finite() const {
    return prf_predictor::is_finite(motion->forecast(0)) &&
           prf_predictor::is_finite(rotation->forecast(0));
  }
};

TrackerResult TargetTracker::process(Stamp stamp, const std::vector<TagMeasurement>& measurements) {
  TrackerResult result;
  if (clock_.observe(stamp) == prf_core::StampOrder::kBackwardJump) {
    history_.clear();
    result.arrival = Arrival::kBackwardJump;
  }
  auto after = std::lower_bound(history_.begin(), history_.end(), stamp,
                                [](const Entry& e, Stamp t) { return e.state.stamp < t; });
  if (after != history_.end() && after->state.stamp == stamp) {
    return {Arrival::kDuplicate, after->state};
  }
  if (after == history_.begin() && !history_.empty()) {
    result.arrival = Arrival::kTooOld;
    result.state.stamp = stamp;
    return result;
  }
  if (after != history_.end()) result.arrival = Arrival::kReplayed;

  after = history_.insert(after, {measurements, {}});
  const auto position = after - history_.begin();
  for (auto entry = after; entry != history_.end(); ++entry) {
    const TrackState before = entry == history_.begin() ? TrackState{} : (entry - 1)->state;
    const Stamp own_stamp = entry == after ? stamp : entry->state.stamp;
    entry->state = step(before, own_stamp, entry->measurements);
  }
  result.state = history_[static_cast<std::size_t>(position)].state;
  while (history_.front().state.stamp < history_.back().state.stamp - kHistory) {
    history_.pop_front();
  }
  return result;
}

TrackState TargetTracker::step(const TrackState& before, Stamp stamp,
                               const std::vector<TagMeasurement>& measurements) const {
  TrackState state;
  state.stamp = stamp;
  state.status = before.status;
  state.belief = before.belief;
  state.last_accepted = before.last_accepted;
  state.orientation = {before.orientation.last_accepted, before.orientation.candidate};
  state.candidates = before.candidates;
  state.measured_motion = before.measured_motion;

  const TagMeasurement* nearest = measurements.empty() ? nullptr : &measurements.front();
  const double since_measurement = to_seconds(stamp - state.last_accepted);
  const bool is_lost = since_measurement > params_.lost_after;
  if (state.belief && !is_lost) {
    Correction target(*state.belief, before.orientation, to_seconds(stamp - before.stamp));
    state.reinitialised = !target.is_finite();
    state.belief.reset();
    if (!state.reinitialised) {
      const Nearest found =
          nearest_to(*target.motion, measurements, params_.gate_speed * since_measurement);
      state.nis = found.nis;
      if (found.measurement != nullptr) nearest = found.measurement;
      state.measured = accept(target, stamp, measurements, since_measurement) != nullptr;
      state.orientation = target.orientation;
      state.belief = Belief{std::move(target.motion), std::move(target.rotation)};
    }
  }
  if (nearest != nullptr) {
    state.measured_motion.add(stamp, nearest->position, nearest->position_covariance,
                              state.measured || !before.belief);
  }
  if (!measurements.empty() && !state.measured) {
    if (state.belief) {
      state.gated = true;
      update_candidates(state, measurements);
    } else {
      state.belief = begin(measurements.front());
      state.orientation = {stamp, std::nullopt};
      state.measured = true;
    }
  }
  if (state.measured) {
    state.last_accepted = stamp;
    state.candidates.clear();
  }
  update_status(state);
  return state;
}

Belief TargetTracker::begin(const TagMeasurement& measurement) const {
  std::unique_ptr<TargetPredictor> motion = predictor_->clone();
  motion->begin(measurement.position, measurement.position_covariance);
  return {std::move(motion),
          std::make_shared<const RotationPredictor>(*predictor_, measurement.orientation,
                                                    measurement.orientation_covariance)};
}

const TagMeasurement* TargetTracker::accept(Correction& target, Stamp stamp,
                                            const std::vector<TagMeasurement>& measurements,
                                            double since_measurement) const {
  const Nearest nearest =
      nearest_to(*target.motion, measurements, params_.gate_speed * since_measurement);
  if (nearest.measurement == nullptr || !(nearest.distance <= gate_)) return nullptr;
  const TagMeasurement& measurement = *nearest.measurement;
  target.motion->correct(measurement.position, measurement.position_covariance);
  target.orientation = follow_orientation(target.orientation, target.rotation, *predictor_,
                                          measurement, stamp, orientation_gate_);
  return &measurement;
}

void TargetTracker::update_candidates(TrackState& state,
                                      const std::vector<TagMeasurement>& measurements) const {
  std::vector<const TagMeasurement*> taken;
  std::vector<TrackState::Candidate> candidates;
  for (const auto& before : state.candidates) {
    const double gap = to_seconds(state.stamp - before.stamp);
    if (gap > params_.lost_after) continue;
    Correction target(before.belief, before.orientation, gap);
    const TagMeasurement* measurement = accept(target, state.stamp, measurements, gap);
    if (measurement == nullptr) continue;
    taken.push_back(measurement);
    candidates.push_back({{std::move(target.motion), std::move(target.rotation)},
                          target.orientation,
                          state.stamp,
                          before.hits + 1});
  }
  for (const TagMeasurement& measurement : measurements) {
    const bool is_taken = std::find(taken.begin(), taken.end(), &measurement) != taken.end();
    if (is_taken || candidates.size() >= kMostCandidates) continue;
    candidates.push_back({begin(measurement), {state.stamp, std::nullopt}, state.stamp, 1});
  }
  state.candidates = std::move(candidates);
  // The oldest first: it is the one that is confirmed first.
  if (state.candidates.empty() || state.candidates.front().hits < params_.reacquire_hits) return;

  state.belief = state.candidates.front().belief;
  state.orientation = state.candidates.front().orientation;
  state.measured = true;
  state.gated = false;
  state.reacquired = true;
}

void TargetTracker::update_status(TrackState& state) const {
  const double gap = state.since_accepted();
  if (!state.belief) {
    state.status = TargetStatus::kNoTarget;
  } else if (gap > params_.lost_after) {
    state.status = TargetStatus::kLost;
  } else {
    state.status = gap > params_.coast_after ? TargetStatus::kCoasting : TargetStatus::kTracking;
  }
}

std::vector<prf_core::TargetPrediction> TargetTracker::forecast(
    const TrackState& state, const std::vector<double>& horizons) const {
  std::vector<prf_core::TargetPrediction> predictions;
  if (!state.belief) return predictions;
  for (const double horizon : horizons) {
    const PointForecast point = state.belief->motion->forecast(horizon);
    const OrientationForecast rotation = state.belief->rotation->forecast(horizon);
    predictions.push_back(
        {prf_core::from_seconds(horizon),
         {{point.position, rotation.orientation}, point.velocity, rotation.angular_velocity},
         point.covariance});
  }
  return predictions;
}

}  // namespace prf_predictor
