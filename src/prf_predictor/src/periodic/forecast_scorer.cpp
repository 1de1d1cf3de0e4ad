// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/forecast_scorer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prf_predictor {
namespace {

constexpr double kShortGap = 0.1;       // s between measurements that are always interpolated
constexpr double kLongestGap = 0.6;     // the same at most, when they usually are as far apart
constexpr double kGapShare = 2.5;       // of the usual interval
constexpr double kUsualShare = 0.1;     // of a new interval in the usual one
constexpr double kFirstEvidence = 0.3;  // s that an inflation of 1 counts for at first
constexpr double kTick = 1e-9;          // s

}  // namespace

ForecastScorer::ForecastScorer(Eigen::Index candidates) {
  for (Sums& sums : sums_) {
    sums.squared_error.setZero(candidates);
    sums.log_error.setZero(candidates);
    sums.scored_until = -kHorizons.back();
  }
}

void ForecastScorer::observe(double time, const Eigen::Vector3d& position,
                             const Eigen::Vector3d& variance, double memory) {
  const double passed = time - measured_time_;
  worst_ = ObservedError();
  if (has_measurement_ && passed > 0) {
    usual_interval_ =
        usual_interval_ > 0 ? usual_interval_ + kUsualShare * (passed - usual_interval_) : passed;
    const double longest = std::clamp(kGapShare * usual_interval_, kShortGap, kLongestGap);
    const Eigen::Vector3d bend = curvature(time, position);
    const double fading = std::exp(-passed / memory);
    for (std::size_t k = 0; k < kHorizons.size(); ++k) {
      Sums& sums = sums_[k];
      sums.evidence *= fading;
      sums.squared_error *= fading;
      sums.log_error *= fading;
      sums.inflation *= fading;
      for (const auto& entry : entries_) {
        const double due = entry->time + kHorizons[k];
        if (entry->time <= sums.scored_until || due > time + kTick) continue;
        sums.scored_until = entry->time;
        if (due < measured_time_ || passed > longest) continue;
        const double since = due - measured_time_;
        const Eigen::Vector3d truth = measured_position_ +
                                      since / passed * (position - measured_position_) -
                                      0.5 * since * (passed - since) * bend;
        const Prediction& prediction = entry->predictions[k];
        const double weight = entry->duration;
        sums.evidence += weight;
        const Eigen::ArrayXd squared =
            (prediction.candidates.colwise() - truth).colwise().squaredNorm();
        sums.squared_error += weight * squared;
        sums.log_error += weight * (squared + variance.sum()).log();
        const Eigen::Array3d own = (prediction.position - truth).array().square();
        if (kHorizons[k] < kShort && passed <= kShortGap) {
          const ObservedError observed{own, prediction.calibrated + variance.array()};
          if (!(observed.ratio() <= worst_.ratio())) worst_ = observed;
        }
        sums.inflation += weight * (own - variance.array()) / prediction.variance.array();
      }
    }
  }
  has_measurement_ = true;
  earlier_time_ = measured_time_;
  earlier_position_ = measured_position_;
  measured_time_ = time;
  measured_position_ = position;
  const double oldest = time - kHorizons.back() - kLongestGap;
  while (!entries_.empty() && entries_.front()->time < oldest) entries_.pop_front();
}

// Of the path through the latest three measurements; 0 when they are too unevenly spaced.
Eigen::Vector3d ForecastScorer::curvature(double time, const Eigen::Vector3d& position) const {
  const double before = measured_time_ - earlier_time_;
  const double passed = time - measured_time_;
  if (!(earlier_time_ >= 0) || before < 0.5 * passed || before > kLongestGap) {
    return Eigen::Vector3d::Zero();
  }
  return 2.0 / (before + passed) *
         ((position - measured_position_) / passed -
          (measured_position_ - earlier_position_) / before);
}

void ForecastScorer::record(double time, Predictions predictions) {
  const double duration = entries_.empty() ? 0.0 : time - entries_.back()->time;
  entries_.push_back(std::make_shared<const Entry>(
      Entry{time, std::min(duration, kLongestGap), std::move(predictions)}));
}

void ForecastScorer::forget() {
  entries_.clear();
  for (Sums& sums : sums_) {
    sums.evidence = 0.0;
    sums.squared_error.setZero();
    sums.log_error.setZero();
    sums.inflation.setZero();
  }
}

Eigen::ArrayXd ForecastScorer::log_error(std::size_t horizon) const {
  return sums_[horizon].log_error / std::max(sums_[horizon].evidence, kTick);
}

double ForecastScorer::squared_error(std::size_t horizon, Eigen::Index candidate) const {
  return sums_[horizon].squared_error(candidate) / std::max(sums_[horizon].evidence, kTick);
}

Eigen::Array3d ForecastScorer::inflation(std::size_t horizon) const {
  const Sums& sums = sums_[horizon];
  const double prior = kFirstEvidence * std::exp(-sums.evidence);
  const double errors = sums.evidence / kIndependent[horizon];
  return (errors + 3) / (errors + 1) * (prior + sums.inflation) / (prior + sums.evidence);
}

BetweenHorizons between_horizons(double horizon) {
  const auto& all = ForecastScorer::kHorizons;
  if (horizon <= all.front()) return {0, 0, 0.0};
  if (horizon >= all.back()) return {all.size() - 1, all.size() - 1, 0.0};
  const auto upper =
      static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), horizon) - all.begin());
  const double width = all[upper] - all[upper - 1];
  return {upper - 1, upper, (horizon - all[upper - 1]) / width};
}

}  // namespace prf_predictor
