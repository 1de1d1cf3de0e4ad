// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/joint_state_joiner.hpp"

#include <algorithm>
#include <prf_core/bounds.hpp>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>

namespace prf_drivers {
namespace {

using prf_core::from_seconds;
using prf_core::Stamp;
using prf_core::StampOrder;

std::string refusal_of(const JointSample& sample) {
  const std::size_t count = sample.names.size();
  if (count == 0) return "it names no joint, must name those that it has positions of";
  if (sample.positions.size() != count)
    return "it has more or fewer positions than names, must have as many";
  if (sample.velocities.size() != count || sample.efforts.size() != count) {
    return "it has more or fewer velocities or efforts than names, must have as many";
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!prf_core::is_within(sample.positions[i], prf_core::kMaxJointPosition) ||
        !prf_core::is_within(sample.velocities[i], prf_core::kMaxAngularSpeed)) {
      return prf_core::quoted(sample.names[i]) +
             " is not finite or beyond all bounds: are its units rad and rad/s?";
    }
  }
  return "";
}

std::string refusal_of(StampOrder order) {
  if (order == StampOrder::kDuplicate) return "its stamp came before";
  if (order == StampOrder::kOld) return "its stamp is older than one that came before";
  return order == StampOrder::kFarAhead ? "its stamp is far ahead" : "";
}

void append(JointSample& tick, const JointSample& sample) {
  for (std::size_t i = 0; i < sample.names.size(); ++i) {
    if (std::count(tick.names.begin(), tick.names.end(), sample.names[i]) > 0) continue;
    tick.names.push_back(sample.names[i]);
    tick.positions.push_back(sample.positions[i]);
    tick.velocities.push_back(sample.velocities[i]);
    tick.efforts.push_back(sample.efforts[i]);
  }
}

}  // namespace

void JointJoinerParams::validate() const {
  prf_core::require_between("number of sources", static_cast<double>(sources), 1.0, 16.0);
  prf_core::require_between("period", period, 0.001, 0.1, "s");
  prf_core::require_between("settle", settle, 0.0, 1.0, "s");
  prf_core::require_between("max_age", max_age, 0.01, 2.0, "s");
}

JointStateJoiner::JointStateJoiner(const JointJoinerParams& params) : params_(params) {
  params_.validate();
  sources_.resize(params_.sources);
}

JointStateJoiner::Added JointStateJoiner::add(std::size_t source, const JointSample& sample) {
  prf_core::require(source < sources_.size(), "source", source, "one of those of the parameters");
  Source& from = sources_[source];
  if (std::string refusal = refusal_of(sample); !refusal.empty()) return {std::nullopt, refusal};
  const StampOrder order = from.clock.observe(sample.stamp);
  if (std::string refusal = refusal_of(order); !refusal.empty()) return {std::nullopt, refusal};
  if (order == StampOrder::kBackwardJump) from.samples.clear();
  from.samples.push_back(sample);
  forget(from);
  if (source != 0 || !is_due(sample.stamp, order)) return {};
  return {joined(sample), ""};
}

// On the grid of the period, with half a period for the jitter of the stamps.
bool JointStateJoiner::is_due(Stamp stamp, StampOrder order) {
  const prf_core::Duration period = from_seconds(params_.period);
  if (order == StampOrder::kBackwardJump) {
    due_.reset();
    filled_.reset();
    given_.reset();
  }
  // A message comes later than its stamp: ticks that were filled in meanwhile are ahead of it.
  if (filled_ && stamp < *filled_ + period / 2) return false;
  if (due_ && stamp < *due_ - period / 2) return false;
  const bool off_grid = !due_ || stamp > *due_ + period / 2;
  due_ = (off_grid ? stamp : *due_) + period;
  given_ = stamp;
  return true;
}

std::optional<JointSample> JointStateJoiner::tick_at(Stamp now) {
  const std::vector<JointSample>& lead = sources_.front().samples;
  if (lead.empty() || (given_ && now < *given_ + from_seconds(params_.period) / 2)) {
    return std::nullopt;
  }
  const double ahead = prf_core::to_seconds(now - lead.back().stamp);
  if (!(ahead >= 0.0 && ahead <= params_.max_age)) return std::nullopt;
  JointSample tick = lead.back();
  tick.stamp = now;
  for (std::size_t i = 0; i < tick.names.size(); ++i) {
    tick.positions[i] += ahead * tick.velocities[i];
  }
  given_ = filled_ = now;
  return joined(std::move(tick));
}

JointSample JointStateJoiner::joined(JointSample tick) const {
  const Stamp latest = tick.stamp - from_seconds(params_.settle);
  const Stamp oldest = tick.stamp - from_seconds(params_.max_age);
  for (std::size_t i = 1; i < sources_.size(); ++i) {
    const std::vector<JointSample>& samples = sources_[i].samples;
    const auto found =
        std::find_if(samples.rbegin(), samples.rend(),
                     [latest](const JointSample& sample) { return sample.stamp <= latest; });
    if (found != samples.rend() && found->stamp >= oldest) append(tick, *found);
  }
  return tick;
}

void JointStateJoiner::forget(Source& source) const {
  // The lead may be a little ahead: what is kept reaches back by twice the time that it needs.
  const Stamp until = source.samples.back().stamp - 2 * from_seconds(params_.settle);
  const auto kept =
      std::find_if(source.samples.begin(), source.samples.end(),
                   [until](const JointSample& sample) { return sample.stamp > until; });
  if (kept - source.samples.begin() > 1) source.samples.erase(source.samples.begin(), kept - 1);
}

}  // namespace prf_drivers
