// SPDX-License-Identifier: BSD-3-Clause
#include "ability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/require.hpp>
#include <stdexcept>

namespace prf_studies {
namespace {

using prf_core::Duration;
using prf_core::from_seconds;
using prf_core::Stamp;
using prf_core::TargetForecast;
using prf_core::TargetStatus;

constexpr Duration kTick = std::chrono::milliseconds(10);
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

bool is_usable(const TargetForecast& forecast) {
  return (forecast.status == TargetStatus::kTracking ||
          forecast.status == TargetStatus::kCoasting) &&
         !forecast.predictions.empty();
}

double deviation_from(const std::optional<prf_core::Pose>& target,
                      const prf_core::Pose& goal_in_target, const Eigen::Vector3d& hand) {
  if (!target) return kUnknown;
  return (target->isometry() * goal_in_target.position - hand).norm();
}

prf_decision::Intent intent_of(double deviation, const AbilityParams& params) {
  if (deviation <= params.clearance) return prf_decision::Intent::kForward;
  return deviation <= params.box_clearance ? prf_decision::Intent::kPause
                                           : prf_decision::Intent::kReverse;
}

}  // namespace

void AbilityParams::validate() const {
  using prf_core::require_between;
  arm.validate();
  prf_core::require_pose("goal_in_target", goal_in_target);
  require_between("lead", lead, 0, 1, "s");
  require_between("latency", latency, 0, 1, "s");
  require_between("warm_up", warm_up, 0, 60, "s");
  require_between("horizon", horizon, 0.01, 60, "s");
  require_between("clearance", clearance, 1e-3, 1, "m");
  require_between("box_clearance", box_clearance, 1e-3, 1, "m");
  prf_core::require(box_clearance > clearance, "box_clearance", box_clearance,
                    "> clearance = " + std::to_string(clearance) + " m");
}

Followed follow(const ObservedRun& run, const AbilityParams& params) {
  params.validate();
  const auto& forecasts = run.forecasts;
  const auto first = std::find_if(forecasts.begin(), forecasts.end(), is_usable);
  if (first == forecasts.end()) {
    throw std::invalid_argument("of " + std::to_string(forecasts.size()) +
                                " forecasts none has a target, must at least one: "
                                "is the tag seen, and long enough for the predictor?");
  }
  const Duration latency = from_seconds(params.latency);
  const Duration lead = from_seconds(params.lead);
  prf_decision::ShadowArm shadow(params.arm);
  shadow.set_goal(params.goal_in_target);

  Followed followed;
  auto next = forecasts.begin();
  for (Stamp tick = first->stamp + latency; next != forecasts.end(); tick += kTick) {
    for (; next != forecasts.end() && next->stamp + latency <= tick; ++next) {
      followed.observed.push_back(shadow.deviation(*next));
    }
    if (next == forecasts.begin()) continue;
    const TargetForecast& newest = *(next - 1);
    shadow.step(tick, kTick, lead, is_usable(newest) ? &newest : nullptr, params.start);
    const auto hand = shadow.hand();
    if (!hand) continue;
    followed.instants.push_back(
        {tick + lead, deviation_from(run.truth(tick + lead), params.goal_in_target, *hand)});
  }
  if (followed.instants.empty()) {
    throw std::invalid_argument(
        "the arm reaches the demonstrated goal at none of the forecasts, must at least once: is "
        "the target as near as in the demonstration?");
  }
  return followed;
}

std::vector<std::optional<prf_decision::Intent>> labels(const ObservedRun& run,
                                                        const std::vector<Instant>& instants,
                                                        const AbilityParams& params) {
  std::vector<std::optional<prf_decision::Intent>> found;
  const auto first_at = [&](Stamp stamp) {
    return std::lower_bound(instants.begin(), instants.end(), stamp,
                            [](const Instant& one, Stamp time) { return one.stamp < time; });
  };
  for (const TargetForecast& forecast : run.forecasts) {
    const Stamp from = forecast.stamp + from_seconds(params.latency);
    const Stamp to = from + from_seconds(params.horizon);
    found.emplace_back();
    const bool counts =
        forecast.stamp >= run.forecasts.front().stamp + from_seconds(params.warm_up) &&
        !instants.empty() && to <= instants.back().stamp;
    if (!counts) continue;
    double largest = 0;
    for (auto one = first_at(from); one != instants.end() && one->stamp <= to; ++one) {
      // Not a number stays: written so that it wins.
      if (!(one->deviation <= largest)) largest = one->deviation;
      if (std::isnan(largest)) break;
    }
    if (!std::isnan(largest)) found.back() = intent_of(largest, params);
  }
  return found;
}

double held_within(const std::vector<Instant>& instants, double share,
                   const AbilityParams& params) {
  prf_core::require_between("share", share, 0, 1);
  std::vector<double> deviations;
  for (const Instant& one : instants) {
    const bool counts = one.stamp >= instants.front().stamp + from_seconds(params.warm_up);
    if (counts && !std::isnan(one.deviation)) deviations.push_back(one.deviation);
  }
  if (deviations.empty()) return kUnknown;
  const double rank = share * static_cast<double>(deviations.size() - 1);
  const auto at = deviations.begin() + std::lround(rank);
  std::nth_element(deviations.begin(), at, deviations.end());
  return *at;
}

}  // namespace prf_studies
