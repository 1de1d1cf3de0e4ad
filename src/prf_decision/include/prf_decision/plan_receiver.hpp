// SPDX-License-Identifier: BSD-3-Clause
// Sorts the planner's results: plans of the demonstration that is executed, plans of the next one
// (which the switch has accepted while the hand returns), refusals, and results without a plan.
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
  Stamp stamp{0};                                  // of the progress that it was made for
  std::shared_ptr<const TargetForecast> forecast;  // that was the newest then
};

struct ReceiveResult {
  std::optional<PlannedSkill> plan;    // to execute from now on
  std::optional<std::string> refusal;  // why the requested demonstration was refused
};

class PlanReceiver {
 public:
  [[nodiscard]] ReceiveResult receive(const PlanResult& result,
                                      const std::shared_ptr<const TargetForecast>& forecast);

  // To be called when the hand is at the start of the previous skill. Takes out the newest plan of
  // the next demonstration and settles the switch; none: there is no next one, or it has no plan
  // yet.
  [[nodiscard]] std::optional<PlannedSkill> arrive();

  [[nodiscard]] DemonstrationSwitch& demonstration() { return demonstration_; }
  [[nodiscard]] const DemonstrationSwitch& demonstration() const { return demonstration_; }
  // Null while there is no next demonstration or it has no plan yet.
  [[nodiscard]] const Trajectory* next_plan() const { return next_.plan.get(); }
  // Why the last result has no plan; none: it has one.
  [[nodiscard]] const std::optional<std::string>& no_plan() const { return no_plan_; }

 private:
  DemonstrationSwitch demonstration_;
  PlannedSkill next_;  // of the accepted demonstration while the hand returns
  std::optional<std::string> no_plan_;
};

}  // namespace prf_decision
