// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/demonstration_switch.hpp"

#include <sstream>

namespace prf_decision {
namespace {

constexpr std::array<const char*, kSwitchStates> kStateNames{"settled", "requested", "returning",
                                                             "returning, requested"};
constexpr std::array<const char*, kSwitchEvents> kEventNames{"request", "accepted", "ended",
                                                             "arrived"};

}  // namespace

const char* name(SwitchState state) { return kStateNames[static_cast<std::size_t>(state)]; }
const char* name(SwitchEvent event) { return kEventNames[static_cast<std::size_t>(event)]; }

std::string switch_markdown() {
  std::ostringstream table;
  table << "| switch | event | next |\n|---|---|---|\n";
  for (const SwitchRow& row : kSwitchTable) {
    table << "| " << name(row.from) << " | " << name(row.event) << " | " << name(row.to) << " |\n";
  }
  return table.str();
}

void DemonstrationSwitch::request(const std::string& name) {
  requested_ = {name, requested_.number + 1};
  requested_at_.reset();
  state_ = step(state_, SwitchEvent::kRequest);
}

PlanFor DemonstrationSwitch::receive(std::uint32_t number, bool refused) {
  if (is_requested() && number == requested_.number) {
    if (!refused) accepted_ = requested_;
    state_ = step(state_, refused ? SwitchEvent::kEnded : SwitchEvent::kAccepted);
    return refused ? PlanFor::kRefused : PlanFor::kAccepted;
  }
  return number == accepted_.number ? PlanFor::kCurrent : PlanFor::kAnotherRequest;
}

bool DemonstrationSwitch::is_overdue(Stamp tick) {
  if (!is_requested()) return false;
  if (!requested_at_) requested_at_ = tick;
  return tick - *requested_at_ > kPatience;
}

}  // namespace prf_decision
