// SPDX-License-Identifier: BSD-3-Clause
// Sorts the planner's results: plans of the demonstration that is executed, plans of the one that
// it is switched to, refusals, and results without a plan.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "prf_decision/demonstration_switch.hpp"
#include "prf_decision/tick_gate.hpp"

namespace prf_decision {

// A plan with what it was made for.
struct PlannedSkill {
  std::shared_ptr<const Trajectory> plan;
  Stamp stamp{0};                                  // of the progress that it answers
  std::shared_ptr<const TargetForecast> forecast;  // that was the newest then
};

struct ReceiveResult {
  std::optional<PlannedSkill> plan;    // to execute from now on
  std::optional<std::string> refusal;  // why the requested demonstration is none
};

class PlanReceiver {
 public:
  [[nodiscard]] ReceiveResult receive(const PlanResult& result,
                                      const std::shared_ptr<const TargetForecast>& forecast);

  // The first plan of the demonstration that it is switched to, which is settled with that; none:
  // nothing is switched, or no plan has come.
  [[nodiscard]] std::optional<PlannedSkill> arrive();

  [[nodiscard]] DemonstrationSwitch& demonstration() { return demonstration_; }
  [[nodiscard]] const DemonstrationSwitch& demonstration() const { return demonstration_; }
  // Null until the demonstration that it is switched to has a plan.
  [[nodiscard]] const Trajectory* next_plan() const { return next_.plan.get(); }
  // Why the last result has no plan; none: it has one.
  [[nodiscard]] const std::optional<std::string>& no_plan() const { return no_plan_; }

 private:
  DemonstrationSwitch demonstration_;
  PlannedSkill next_;  // of the accepted demonstration while the hand returns
  std::optional<std::string> no_plan_;
};

}  // namespace prf_decision
