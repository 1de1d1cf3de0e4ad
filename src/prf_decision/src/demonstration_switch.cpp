// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/demonstration_switch.hpp"

namespace prf_decision {

void DemonstrationSwitch::ask(const std::string& name) {
  asked_ = NamedDemonstration{name, ++count_};
  asked_at_.reset();
}

Reply DemonstrationSwitch::take(std::uint32_t number, bool refused) {
  if (asked_ && number == asked_->number) {
    if (!refused) taken_up_ = *asked_;
    asked_.reset();
    return refused ? Reply::kRefused : Reply::kTakenUp;
  }
  return number == taken_up_.number ? Reply::kPlan : Reply::kOfAnother;
}

bool DemonstrationSwitch::is_overdue(Stamp tick) {
  if (!asked_) return false;
  if (!asked_at_) asked_at_ = tick;
  return tick - *asked_at_ > kPatience;
}

}  // namespace prf_decision
