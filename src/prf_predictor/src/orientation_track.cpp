// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/orientation_track.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <prf_core/se3.hpp>

#include "prf_predictor/gaussian.hpp"

namespace prf_predictor {

using prf_core::Stamp;
using prf_core::to_seconds;

namespace {

double squared_distance(const OrientationForecast& expected, const Eigen::Quaterniond& measured,
                        const Eigen::Matrix3d& noise, double widening) {
  const Eigen::Vector3d residual =
      prf_core::log_so3((measured * expected.orientation.conjugate()).normalized());
  const Eigen::Matrix3d S = expected.covariance + noise + widening * Eigen::Matrix3d::Identity();
  return residual.dot(repaired(S).llt().solve(residual));
}

// The orientation of a measurement that is nearer to what is expected.
struct Nearer {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  bool is_alternative = false;
  bool passes = false;
  double nis = 0.0;
};

Nearer nearer_to(const RotationPredictor& rotation, const TagMeasurement& measurement,
                 double since_accepted, const OrientationGate& gate) {
  const OrientationForecast expected = rotation.forecast(0);
  const double widening = std::pow(gate.sigma, 2) + std::pow(gate.speed * since_accepted, 2);
  const auto distance = [&](const Eigen::Quaterniond& orientation, double more) {
    return squared_distance(expected, orientation, measurement.orientation_covariance, more);
  };
  Nearer result{measurement.orientation, false, false, 0.0};
  double nearest = distance(measurement.orientation, widening);
  if (measurement.alternative && measurement.ambiguity > OrientationGate::kClear) {
    const double other = distance(*measurement.alternative, widening);
    if (other < nearest) {
      nearest = other;
      result.orientation = *measurement.alternative;
      result.is_alternative = true;
    }
  }
  result.passes = nearest <= gate.chi_square;
  result.nis = distance(result.orientation, 0.0);
  return result;
}

double evidence_of(const TagMeasurement& measurement) {
  if (!measurement.alternative || !(measurement.ambiguity > OrientationGate::kClear)) return 1.0;
  return std::pow(std::log(measurement.ambiguity) / std::log(OrientationGate::kClear), 2);
}

// Of the orientation that the detector prefers.
OrientationCandidate next_candidate(const std::optional<OrientationCandidate>& before,
                                    const TargetPredictor& prototype,
                                    const TagMeasurement& measurement, Stamp stamp,
                                    const OrientationGate& gate) {
  TagMeasurement preferred = measurement;
  preferred.alternative.reset();
  const double evidence = evidence_of(measurement);
  const double gap = before ? to_seconds(stamp - before->stamp) : 0.0;
  if (before && gap <= gate.longest_gap) {
    auto rotation = std::make_shared<RotationPredictor>(*before->rotation);
    rotation->advance(gap);
    if (nearer_to(*rotation, preferred, gap, gate).passes) {
      rotation->correct(preferred.orientation, preferred.orientation_covariance);
      return {rotation, stamp, before->evidence + evidence};
    }
  }
  return {std::make_shared<RotationPredictor>(prototype, preferred.orientation,
                                              preferred.orientation_covariance),
          stamp, evidence};
}

}  // namespace

OrientationTrack follow_orientation(const OrientationTrack& before,
                                    std::unique_ptr<RotationPredictor>& rotation,
                                    const TargetPredictor& prototype,
                                    const TagMeasurement& measurement, Stamp stamp,
                                    const OrientationGate& gate) {
  OrientationTrack track;
  track.last_accepted = before.last_accepted;
  const Nearer nearer =
      nearer_to(*rotation, measurement, to_seconds(stamp - before.last_accepted), gate);
  track.nis = nearer.nis;
  track.gated = !nearer.passes;
  track.alternative = nearer.passes && nearer.is_alternative;
  if (nearer.passes) {
    rotation->correct(nearer.orientation, measurement.orientation_covariance);
    track.last_accepted = stamp;
  }
  if (track.gated || track.alternative) {
    track.candidate = next_candidate(before.candidate, prototype, measurement, stamp, gate);
    if (track.candidate->evidence >= gate.evidence) {
      rotation = std::make_unique<RotationPredictor>(*track.candidate->rotation);
      track.candidate.reset();
      track.last_accepted = stamp;
      track.gated = false;
      track.alternative = false;
      track.reacquired = true;
    }
  }
  return track;
}

}  // namespace prf_predictor
