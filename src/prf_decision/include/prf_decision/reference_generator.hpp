// SPDX-License-Identifier: BSD-3-Clause
// Says where the hand shall be. It moves the cursor along the plan as the published state says. It
// takes the reference from the plan, its approach or the target. It moves the set-point toward the
// reference with a limited step (setpoint_limiter.hpp).
//
//   state                        cursor    reference
//   forward                      forward   the plan; on the approach relative to the target
//   reverse, retract             back      the same
//   pause                        stands    on the approach relative to the target, else none
//   tracking, done               stands    the demonstrated pose relative to the target, predicted
//                                          for `lead` after the tick; none during a violation;
//                                          adapted once: the plan's last pose
//   search                       stands    where the camera looks; the set-point begins where the
//                                          hand is measured while that does not follow
//   waiting, stopped             stands    none; the set-point begins where the hand is measured
// On its way the hand keeps its view of the target (view_keeper.hpp), but when adapted once.
// Without a reference the set-point stands still; in waiting and stopped there is no set-point,
// and the arm holds. While the arm does not follow, the cursor waits: forward always, back where it
// would lead away from the measured hand.
#pragma once

#include <memory>
#include <optional>

#include "prf_decision/approach.hpp"
#include "prf_decision/decision_fsm.hpp"
#include "prf_decision/following_monitor.hpp"
#include "prf_decision/plan_receiver.hpp"
#include "prf_decision/setpoint_limiter.hpp"
#include "prf_decision/view_keeper.hpp"

namespace prf_decision {

enum class Adaptation {
  kContinuous,  // to every forecast; HMM and guards steer the execution
  kOnce         // to the first forecast, then executed whatever the target does
};

struct ReferenceParams {
  Adaptation adaptation = Adaptation::kContinuous;
  Duration lead{0};               // the tracked goal is taken this long after the tick
  double approach_length = 0;     // end of the skill that is executed relative to the target, m
  double view_angle = 3.2;        // view_keeper.hpp, rad; 3.2: the hand stays as planned
  double tracking_tolerance = 0;  // distance of the set-point from its reference, m
  CatchUpParams catch_up;

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

struct ReferenceInput {
  Stamp stamp{0};
  Duration since_last_tick{0};
  ExecutionState state = ExecutionState::kWaiting;
  std::optional<Pose> hand;          // as measured; none: not known
  const TargetForecast* forecast{};  // null: none that the hand may follow
  bool violation = false;            // a guard reports one: the target is not tracked
  bool follows = true;               // the arm does
  bool hand_on_goal = false;         // within goal_tolerance of the set-point before
  std::optional<Pose> look = {};     // of the hand that searches; none: it does not
  double speed = 1.0;                // share, 0 .. 1, of the cursor's speed and of catching up
};

struct ReferenceResult {
  std::optional<MovingPose> setpoint;  // none: hold
  bool at_start = false;               // cursor, set-point and hand are at the start of the plan
};

struct GoalDistance {
  double distance = 0;  // to where the skill ends now, m
  double axis = 0;      // to the line through there along the hand's z axis, m
};

class ReferenceGenerator {
 public:
  explicit ReferenceGenerator(const ReferenceParams& params) : params_(params) {}

  void set_params(const ReferenceParams& params) { params_ = params; }

  // A newer plan of the same demonstration; the cursor stays where it is.
  void update_plan(const PlannedSkill& planned);
  // The first plan of another demonstration.
  void replace_plan(const PlannedSkill& planned);

  // One tick.
  [[nodiscard]] ReferenceResult step(const ReferenceInput& input);

  [[nodiscard]] const Trajectory* plan() const { return plan_.get(); }
  [[nodiscard]] double cursor() const { return cursor_; }
  [[nodiscard]] bool is_complete() const { return plan_ && at_end(*plan_, cursor_); }
  // Whether the cursor is on the approach, or at the end of the plan.
  [[nodiscard]] bool is_at_target() const;
  // Whether the hand is where the cursor is; true without a plan.
  [[nodiscard]] bool is_on_skill(const Pose& hand, const PoseTolerance& tolerance) const;
  // For how long, without interruption, the state has been tracking, the set-point within
  // tracking_tolerance of its reference, and the hand on the set-point; none: it is not so now.
  [[nodiscard]] std::optional<Duration> tracked_for(Stamp stamp) const;
  // From the measured hand to the goal at this tick; none without a plan or prediction.
  [[nodiscard]] std::optional<GoalDistance> goal_distance(const Pose& hand,
                                                          const TargetForecast& forecast,
                                                          Stamp stamp) const;

 private:
  void move_cursor(const ReferenceInput& input);
  [[nodiscard]] bool leads_away(const ReferenceInput& input, double cursor) const;
  void follow_target(const ReferenceInput& input);
  [[nodiscard]] bool is_relative_to_target() const;
  [[nodiscard]] MovingPose hand_on_plan(Direction direction) const;
  [[nodiscard]] MovingPose moving(Direction direction, double speed) const;
  [[nodiscard]] std::optional<MovingPose> reference(const ReferenceInput& input) const;

  ReferenceParams params_;
  std::shared_ptr<const Trajectory> plan_;
  Approach approach_;  // of the plan
  double cursor_ = 0;
  std::optional<MovingPose> target_;  // that the approach follows
  std::optional<Pose> setpoint_;
  std::optional<Stamp> tracked_since_;
};

}  // namespace prf_decision
