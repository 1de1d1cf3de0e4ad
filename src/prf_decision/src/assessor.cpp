// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/assessor.hpp"

#include <utility>

#include "sentence.hpp"

namespace prf_decision {
namespace {

Event event_of(Intent intent) {
  switch (intent) {
    case Intent::kForward:
      return Event::kCalm;
    case Intent::kPause:
      return Event::kUnsteady;
    case Intent::kReverse:
      break;
  }
  return Event::kUnstable;
}

std::string describe(const BeliefTracker& belief) {
  if (belief.was_reset()) return "the belief was no distribution: reset";
  const auto index = static_cast<std::size_t>(belief.intent());
  return sentence("belief in ", kIntentNames[index], " ",
                  belief.posterior()[static_cast<Eigen::Index>(index)], ", target speed ",
                  belief.speed(), " m/s");
}

bool waits_at_start(const AssessmentInput& input) {
  return input.at_start && published(input.state) == ExecutionState::kWaiting;
}

Event graded(Event event, bool lasts, bool may_be_lost, const AssessmentInput& input) {
  if (event == Event::kHazard && lasts) event = Event::kOverdue;
  if (event == Event::kLost && !may_be_lost) event = Event::kOverdue;
  const bool stays = waits_at_start(input) || (is_resting(input.state) && !input.at_target);
  return event == Event::kOverdue && stays ? Event::kHazard : event;
}

// The predictor is heard and says that the target was not seen for too long.
bool is_out_of_sight(const GuardParams& params, const GuardInput& input) {
  return input.measured && !input.forecast_silent &&
         input.tick - *input.measured > params.reverse_after;
}

}  // namespace

// What only the search decides; none: what the guards and the HMM say counts.
std::optional<Assessment> Assessor::assess_sight(const GuardParams& params,
                                                 const AssessmentInput& input,
                                                 const std::optional<Violation>& violation) {
  const bool searches = input.state == State::kSearch;
  const Stamp tick = input.guards.tick;
  if (!searches) {
    searching_.reset();
  } else if (!searching_) {
    searching_ = tick;
  }
  if (violation && violation->event == Event::kGiveUp) return std::nullopt;
  const bool out_of_sight = is_out_of_sight(params, input.guards);
  if (searches && !out_of_sight) {
    return Assessment{Event::kClear, "the target is in sight again", violation.has_value(), ""};
  }
  if (!out_of_sight || !(searches || (input.can_search && !is_resting(input.state))))
    return std::nullopt;
  const double age = to_seconds(tick - *input.guards.measured);
  const double limit = to_seconds(input.search_time);
  if (!searches) {
    return Assessment{Event::kMissing,
                      sentence("target out of sight for ", age, " s: looks for it"), true, ""};
  }
  const Duration lasting = tick - *searching_;
  if (lasting > input.search_time) {
    return Assessment{Event::kLost, sentence("target not found within ", limit, " s"), true, ""};
  }
  return Assessment{
      Event::kHazard,
      sentence("target out of sight for ", age, " s: looks ", input.search_width,
               " rad around its last place, for ", to_seconds(lasting), " of ", limit, " s"),
      true, ""};
}

Assessment Assessor::assess(const GuardParams& params, Duration dwell_time,
                            const BeliefTracker& belief, const AssessmentInput& input) {
  const Stamp tick = input.guards.tick;
  auto violation = check_guards(params, input.guards, input.adapted_once);
  const Intent intent = input.adapted_once ? Intent::kForward : belief.intent();
  hazard_.update(tick, violation.has_value(), dwell_time);
  if (waits_at_start(input)) hazard_.reset();
  unsteady_.update(tick, input.at_target && intent != Intent::kForward, dwell_time);
  if (is_rewinding(input.state)) rewound_ = tick;
  const bool may_be_lost = input.at_start && !(rewound_ && tick - *rewound_ <= params.stop_after);
  const bool may_leave = input.at_target || !is_resting(input.state);
  if (auto sight = assess_sight(params, input, violation)) return *sight;
  if (violation) {
    const bool lasts = hazard_.time(tick) > params.reverse_after;
    return {graded(violation->event, lasts, may_be_lost, input), std::move(violation->reason), true,
            intent == Intent::kReverse && may_leave ? describe(belief) : ""};
  }
  if (is_rewinding(input.state))
    return {Event::kClear, "back to the start of the skill", false, ""};
  if (input.away && input.state == State::kWaiting) {
    return {Event::kAway, "the hand is away from the skill: first to its start", false, ""};
  }
  if (intent == Intent::kForward || !may_leave) return {Event::kCalm, "", false, ""};
  const bool too_long = unsteady_.time(tick) > params.stop_after;
  return {too_long ? Event::kOverdue : event_of(intent), describe(belief), false, ""};
}

}  // namespace prf_decision
