// SPDX-License-Identifier: BSD-3-Clause
// Which demonstration the planner is asked to follow, and which one is executed.
//
//   asked        named by an order; the planner has not answered yet
//   taken up     the planner has it, and plans it
//   in force     executed: the cursor runs along its plan
//
// One after the other. What is asked for but refused, withdrawn or not answered in time leaves the
// one taken up before. Answers are told apart by the number under which a demonstration was asked
// for, which comes back with them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "prf_decision/types.hpp"

namespace prf_decision {

struct NamedDemonstration {
  std::string name;  // empty: the one that the planner started with
  std::uint32_t number = 0;
};

enum class Reply { kOfAnother, kRefused, kTakenUp, kPlan };

class DemonstrationSwitch {
 public:
  static constexpr Duration kPatience = std::chrono::seconds(5);  // data time, for the answer

  void ask(const std::string& name);  // from the next tick on
  void withdraw() { asked_.reset(); }
  void come_into_force() { in_force_ = taken_up_.number; }

  // What an answer of the planner is, to which demonstration's number and whether refused.
  [[nodiscard]] Reply take(std::uint32_t number, bool refused);

  // Whether the answer is overdue at this tick; counts from the first one.
  [[nodiscard]] bool is_overdue(Stamp tick);

  bool is_asking() const { return asked_.has_value(); }
  bool is_taking_over() const { return taken_up_.number != in_force_; }
  const NamedDemonstration& wanted() const { return asked_ ? *asked_ : taken_up_; }

 private:
  std::optional<NamedDemonstration> asked_;
  std::optional<Stamp> asked_at_;
  NamedDemonstration taken_up_;
  std::uint32_t in_force_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace prf_decision
