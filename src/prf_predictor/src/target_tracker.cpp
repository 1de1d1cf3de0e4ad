// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/target_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <prf_core/require.hpp>
#include "prf_predictor/gaussian.hpp"

namespace prf_predictor {

using prf_core::require;
namespace {

double seconds(Nanoseconds duration) { return 1e-9 * static_cast<double>(duration); }

struct Nearest {
  const TagMeasurement* sight = nullptr;
  double nis = 0.0;
  double distance = std::numeric_limits<double>::infinity();  // the same, by the widened covariance
};

double squared_distance(const Eigen::Vector3d& residual, const Eigen::Matrix3d& covariance) {
  return residual.dot(repaired(covariance).llt().solve(residual));
}

// By the Mahalanobis distance to where the target is expected now.
Nearest nearest_to(const TargetPredictor& target, const std::vector<TagMeasurement>& sights,
                   double widening) {
  const PointForecast expected = target.forecast(0);
  Nearest nearest;
  for (const TagMeasurement& sight : sights) {
    const Eigen::Vector3d residual = sight.position - expected.position;
    const Eigen::Matrix3d S = expected.covariance.topLeftCorner<3, 3>() + sight.position_covariance;
    const Eigen::Matrix3d widened = S + std::pow(widening, 2) * Eigen::Matrix3d::Identity();
    const double distance = squared_distance(residual, widened);
    if (distance < nearest.distance) nearest = {&sight, squared_distance(residual, S), distance};
  }
  return nearest;
}

double squared_distance(const OrientationForecast& expected, const TagMeasurement& sight,
                        double gate_sigma) {
  const Eigen::Vector3d residual =
      rotation_vector((sight.orientation * expected.orientation.conjugate()).normalized());
  return squared_distance(residual, expected.covariance + sight.orientation_covariance +
                                        std::pow(gate_sigma, 2) * Eigen::Matrix3d::Identity());
}

}  // namespace

void validate(const TrackerParams& params) {
  require(params.gate_probability > 0.5 && params.gate_probability < 1, "gate_probability",
          params.gate_probability, "> 0.5 and < 1");
  require(params.gate_speed >= 0 && std::isfinite(params.gate_speed), "gate_speed",
          params.gate_speed, "finite and >= 0 m/s");
  require(params.orientation_gate_sigma >= 0 && std::isfinite(params.orientation_gate_sigma),
          "orientation_gate_sigma", params.orientation_gate_sigma, "finite and >= 0 rad");
  require(params.reacquire_hits >= 2, "reacquire_hits", params.reacquire_hits, ">= 2");
  require(params.coast_after > 0 && std::isfinite(params.coast_after), "coast_after",
          params.coast_after, "finite and > 0 s");
  require(params.lost_after > params.coast_after && params.lost_after <= 3600, "lost_after",
          params.lost_after, "> coast_after and <= 3600 s");
}

TargetTracker::TargetTracker(const TrackerParams& params,
                             std::shared_ptr<const TargetPredictor> predictor)
    : params_(params), predictor_(std::move(predictor)) {
  validate(params);
  require(predictor_ != nullptr, "predictor", "null", "given");
  gate_ = chi_square_quantile_3(params.gate_probability);
}

TargetTracker::Moving::Moving(const Belief& before, double dt)
    : motion(before.motion->clone()),
      rotation(std::make_unique<RotationPredictor>(*before.rotation)) {
  motion->advance(dt);
  rotation->advance(dt);
}

bool TargetTracker::Moving::is_finite() const {
  return prf_predictor::is_finite(motion->forecast(0)) &&
         prf_predictor::is_finite(rotation->forecast(0));
}

TargetTracker::Answer TargetTracker::process(Nanoseconds stamp,
                                             const std::vector<TagMeasurement>& sights) {
  Answer answer;
  if (!history_.empty() && stamp < history_.back().state.stamp - kHistory) {
    history_.clear();
    answer.arrival = Arrival::kNewRun;
  }
  auto after = std::lower_bound(history_.begin(), history_.end(), stamp,
                                [](const Entry& e, Nanoseconds t) { return e.state.stamp < t; });
  if (after != history_.end() && after->state.stamp == stamp) {
    return {Arrival::kDuplicate, after->state};
  }
  if (after == history_.begin() && !history_.empty()) {
    answer.arrival = Arrival::kTooOld;
    answer.state.stamp = stamp;
    return answer;
  }
  if (after != history_.end()) answer.arrival = Arrival::kReplayed;

  after = history_.insert(after, {sights, {}});
  const auto position = after - history_.begin();
  for (auto entry = after; entry != history_.end(); ++entry) {
    const TrackState before = entry == history_.begin() ? TrackState{} : (entry - 1)->state;
    const Nanoseconds own_stamp = entry == after ? stamp : entry->state.stamp;
    entry->state = step(before, own_stamp, entry->sights);
  }
  answer.state = history_[static_cast<std::size_t>(position)].state;
  while (history_.front().state.stamp < history_.back().state.stamp - kHistory) {
    history_.pop_front();
  }
  return answer;
}

TrackState TargetTracker::step(const TrackState& before, Nanoseconds stamp,
                               const std::vector<TagMeasurement>& sights) const {
  TrackState state;
  state.stamp = stamp;
  state.status = before.status;
  state.belief = before.belief;
  state.last_accepted = before.last_accepted;
  state.candidate = before.candidate;

  const bool is_lost = seconds(stamp - state.last_accepted) > params_.lost_after;
  if (state.belief && !is_lost) {
    Moving target(*state.belief, seconds(stamp - before.stamp));
    state.reinitialised = !target.is_finite();
    state.belief.reset();
    if (!state.reinitialised) {
      state.measured = accept(target, sights, seconds(stamp - state.last_accepted), state);
      state.belief = Belief{std::move(target.motion), std::move(target.rotation)};
    }
  }
  if (!sights.empty() && !state.measured) {
    if (state.belief) {
      state.gated = true;
      pursue_candidate(state, sights);
    } else {
      state.belief = begin(sights.front());
      state.measured = true;
    }
  }
  if (state.measured) {
    state.last_accepted = stamp;
    state.candidate.reset();
  }
  settle_status(state);
  return state;
}

Belief TargetTracker::begin(const TagMeasurement& sight) const {
  std::unique_ptr<TargetPredictor> motion = predictor_->clone();
  motion->begin(sight.position, sight.position_covariance);
  return {std::move(motion), std::make_shared<const RotationPredictor>(
                                 *predictor_, sight.orientation, sight.orientation_covariance)};
}

bool TargetTracker::accept(Moving& target, const std::vector<TagMeasurement>& sights, double unseen,
                           TrackState& state) const {
  const Nearest nearest = nearest_to(*target.motion, sights, params_.gate_speed * unseen);
  if (nearest.sight == nullptr) return false;
  state.nis = nearest.nis;
  if (!(nearest.distance <= gate_)) return false;
  const TagMeasurement& sight = *nearest.sight;
  target.motion->correct(sight.position, sight.position_covariance);

  const OrientationForecast expected = target.rotation->forecast(0);
  state.orientation_nis = squared_distance(expected, sight, 0.0);
  state.orientation_gated =
      !(squared_distance(expected, sight, params_.orientation_gate_sigma) <= gate_);
  if (!state.orientation_gated) {
    target.rotation->correct(sight.orientation, sight.orientation_covariance);
  }
  return true;
}

void TargetTracker::pursue_candidate(TrackState& state,
                                     const std::vector<TagMeasurement>& sights) const {
  auto& candidate = state.candidate;
  if (candidate && seconds(state.stamp - candidate->stamp) > params_.lost_after) candidate.reset();
  if (candidate) {
    const double unseen = seconds(state.stamp - candidate->stamp);
    Moving target(candidate->belief, unseen);
    TrackState of_candidate;
    if (accept(target, sights, unseen, of_candidate)) {
      candidate->belief = {std::move(target.motion), std::move(target.rotation)};
      candidate->stamp = state.stamp;
      ++candidate->hits;
    } else {
      candidate.reset();
    }
  }
  if (!candidate) candidate = TrackState::Candidate{begin(sights.front()), state.stamp, 1};
  if (candidate->hits < params_.reacquire_hits) return;

  state.belief = candidate->belief;
  state.measured = true;
  state.gated = false;
  state.reacquired = true;
}

void TargetTracker::settle_status(TrackState& state) const {
  const double gap = seconds(state.stamp - state.last_accepted);
  if (!state.belief) {
    state.status = TrackStatus::kNoTarget;
  } else if (gap > params_.lost_after) {
    state.status = TrackStatus::kLost;
  } else {
    state.status = gap > params_.coast_after ? TrackStatus::kCoasting : TrackStatus::kTracking;
  }
}

std::vector<Prediction> TargetTracker::forecast(const TrackState& state,
                                                const std::vector<double>& horizons) const {
  std::vector<Prediction> predictions;
  if (!state.belief) return predictions;
  for (const double horizon : horizons) {
    predictions.push_back({horizon, state.belief->motion->forecast(horizon),
                           state.belief->rotation->forecast(horizon)});
  }
  return predictions;
}

}  // namespace prf_predictor
