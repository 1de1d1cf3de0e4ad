// SPDX-License-Identifier: BSD-3-Clause
#include "health.hpp"

#include <ros/console.h>

namespace prf_predictor {
namespace {

constexpr double kPeriodicityHorizon = 1.0;  // s, of the probability in the diagnostics

}  // namespace

Health::Health() {
  updater_.setHardwareID("none");
  updater_.add("target", this, &Health::fill);
}

void Health::warn(const std::string& what, const std::string& detail) {
  count(what);
  if (told_.is_due(what)) ROS_WARN("%s: %s", what.c_str(), detail.c_str());
}

void Health::drop(const std::string& reason, const std::string& detail) {
  count("dropped: " + reason);
  if (!told_.is_due(reason)) return;
  ROS_WARN("measurement dropped, %s%s%s", reason.c_str(), detail.empty() ? "" : ": ",
           detail.c_str());
}

void Health::report(const TrackerResult& result) {
  const auto& [arrival, state] = result;
  status_ = state.status;
  belief_ = state.belief;
  count("images");
  if (state.measured) count("measurements accepted");
  if (arrival == Arrival::kDuplicate) drop("duplicate stamp");
  if (arrival == Arrival::kTooOld) drop("older than all history");
  if (arrival == Arrival::kReplayed) count("images replayed out of order");
  if (state.gated) drop("outside the gate", "NIS " + std::to_string(state.nis));
  if (state.orientation.gated) {
    drop("orientation outside the gate", "NIS " + std::to_string(state.orientation.nis));
  }
  if (state.orientation.alternative) count("pose flips, the tag's other pose was used");
  if (state.orientation.reacquired) count("orientations re-acquired");
  if (state.reacquired) count("targets re-acquired");
  if (state.reinitialised) drop("belief not finite", "filter starts anew");
}

void Health::fill(diagnostic_updater::DiagnosticStatusWrapper& status) {
  static constexpr const char* kNames[] = {"no target", "tracking", "coasting", "lost"};
  using diagnostic_msgs::DiagnosticStatus;
  const bool is_good = status_ == TargetStatus::kTracking;
  status.summary(is_good ? DiagnosticStatus::OK : DiagnosticStatus::WARN,
                 kNames[static_cast<int>(status_)]);
  if (inputs_ != nullptr) inputs_->report(status);
  status.add("waiting for tf", waiting_);
  for (const auto& [name, number] : counts_) status.add(name, number);
  if (!belief_) return;
  if (const auto periodicity = belief_->motion->periodicity(kPeriodicityHorizon)) {
    std::string frequencies;
    for (const double frequency : periodicity->frequencies) {
      frequencies += (frequencies.empty() ? "" : ", ") + std::to_string(frequency);
    }
    status.addf("probability of periodic motion", "%.3f", periodicity->probability);
    status.add("frequencies, rad/s", frequencies);
  }
}

}  // namespace prf_predictor
