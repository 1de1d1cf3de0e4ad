// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/plan_receiver.hpp"

#include <utility>

namespace prf_decision {

ReceiveResult PlanReceiver::receive(const PlanResult& result,
                                    const std::shared_ptr<const TargetForecast>& forecast) {
  switch (demonstration_.receive(result.demonstration_switch, result.refused)) {
    case PlanFor::kAnotherRequest:
      return {};
    case PlanFor::kRefused:
      return {std::nullopt, result.message};
    case PlanFor::kAccepted:
      next_ = {};
      break;
    case PlanFor::kCurrent:
      break;
  }
  no_plan_.reset();
  if (!result.plan) {
    no_plan_ = result.message;
    return {};
  }
  const PlannedSkill planned{result.plan, result.stamp, forecast};
  if (!demonstration_.is_returning()) return {planned, std::nullopt};
  next_ = planned;
  return {};
}

std::optional<PlannedSkill> PlanReceiver::arrive() {
  if (!demonstration_.is_returning() || !next_.plan) return std::nullopt;
  demonstration_.arrive();
  return std::exchange(next_, {});
}

}  // namespace prf_decision
