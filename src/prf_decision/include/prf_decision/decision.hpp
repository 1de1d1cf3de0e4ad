// SPDX-License-Identifier: BSD-3-Clause
// One tick of the decision: belief, guards, state machine, cursor, set-point.
//
// framework true: the HMM and the guards steer the execution and the hand follows the forecast at
// its end. false: blind, the skill is executed to its end whatever the target does, and the last
// pose is held.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "prf_decision/approach.hpp"
#include "prf_decision/decision_fsm.hpp"
#include "prf_decision/demonstration_switch.hpp"
#include "prf_decision/guards.hpp"
#include "prf_decision/hmm.hpp"
#include "prf_decision/setpoint_limiter.hpp"
#include "prf_decision/tick_gate.hpp"
#include "prf_decision/types.hpp"

namespace prf_decision {

struct DecisionParams {
  bool framework = true;
  bool autostart = true;          // the first execution begins without an order
  Duration max_gap{0};            // between ticks, beyond it joint_states count as silent
  Duration lead{0};               // the followed goal is taken this long after the tick
  Duration hold_time{0};          // the target must be tracked for this long
  Duration dwell_time{0};         // least time in a state before the HMM may change it
  Duration time_limit{0};         // from the execution's first tick
  double tracking_tolerance = 0;  // set-point to goal, m
  double approach_length = 0;     // of the skill's end that belongs to the target, m
  CatchUpParams catch_up;
  GuardParams guards;
  HmmParams hmm;

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

// What an execution is asked for.
struct Order {
  Duration time_limit{0};          // 0: as in the parameters
  Duration hold_time{0};           // 0: as in the parameters
  bool resume = false;             // from where the cursor stands; else back to the start first
  std::string demonstration = {};  // as the planner takes it; empty: the one taken up before

  void validate() const;
};

struct Progress {
  Stamp stamp{0};
  Stamp forecast_stamp{0};  // 0: none in force
  State state = State::kWaiting;
  std::string reason;  // why the state holds; empty while nothing is to be said
  Eigen::Vector3d posterior = Eigen::Vector3d::Zero();
  double cursor = 0;
  std::size_t frozen = 0;
  Duration time_to_go{0};
  double share = 0;                     // of the skill executed, 0 .. 1
  Event cause = Event::kCalm;           // that led into the state
  std::optional<double> goal_distance;  // set-point to where the skill ends now, m
  std::optional<double> axis_distance;  // the same to the line along which the hand arrives there
  NamedDemonstration demonstration;     // that the planner shall follow
  std::string refusal;                  // why the one asked for is no longer, at this tick
};

struct Outcome {
  Progress progress;
  std::optional<MovingPose> setpoint;  // none: hold
};

class Decision {
 public:
  // Validates the parameters.
  explicit Decision(const DecisionParams& parameters);

  [[nodiscard]] Outcome update(const Tick& tick);

  // An execution can be ordered when none is under way. It begins with the next tick; one that
  // names a demonstration at the tick at which the planner has taken that up, or not at all: see
  // Progress::refusal.
  [[nodiscard]] bool can_begin() const;
  void begin(const Order& order);
  [[nodiscard]] bool is_asking() const { return demonstration_switch_.is_asking(); }

  // Other parameters from the next tick on; framework, autostart and the HMM stay as they are.
  void tune(const DecisionParams& parameters);

  // Stops whatever is under way at the next tick, in any state.
  void preempt() { preempted_ = true; }

 private:
  struct Assessment {
    Event event;
    std::string reason;
    bool objected;  // a guard spoke, not the HMM
  };

  // A plan with what it was made for.
  struct Planned {
    std::shared_ptr<const Trajectory> plan;
    Stamp stamp{0};
    std::shared_ptr<const TargetForecast> forecast;
  };

  void begin_execution(Stamp stamp);
  void take_in(const Tick& tick);
  void take_answer(const PlanAnswer& answer);
  void adopt(const Planned& planned);
  void take_over_when_at_the_start();
  void stop_asking(Stamp stamp);
  [[nodiscard]] std::optional<Objection> object_to_target(const Tick& tick) const;
  [[nodiscard]] std::optional<Objection> object(const Tick& tick) const;
  [[nodiscard]] Assessment assess(const Tick& tick) const;
  void change_state(const Tick& tick, const Assessment& assessment);
  [[nodiscard]] bool try_event(Stamp stamp, Event event, const std::string& reason);
  [[nodiscard]] const std::shared_ptr<const Trajectory>& newest_plan() const;
  void follow_target(const Tick& tick);
  [[nodiscard]] bool is_bound_to_target() const;
  [[nodiscard]] MovingPose hand_on_plan(Direction direction) const;
  [[nodiscard]] std::optional<MovingPose> reference(Stamp stamp, bool objected) const;
  [[nodiscard]] std::optional<MovingPose> move(const Tick& tick, bool objected);
  [[nodiscard]] Progress report(Stamp stamp) const;

  DecisionParams parameters_;
  HmmFilter hmm_;
  HmmBelief belief_;
  State state_ = State::kWaiting;
  Event cause_ = Event::kCalm;
  std::string reason_;
  std::optional<Order> order_;      // that is to begin
  std::optional<Order> execution_;  // under way or ended
  bool preempted_ = false;
  bool rewinding_ = false;  // the cursor, then the hand, goes back to the start first
  Stamp begun_{0};          // the execution
  std::optional<Stamp> last_tick_;
  Stamp entered_{0};  // when the state was entered
  std::shared_ptr<const TargetForecast> forecast_;
  std::shared_ptr<const Trajectory> plan_;
  DemonstrationSwitch demonstration_switch_;
  Planned next_;         // of the demonstration taken up, until it comes into force
  std::string refusal_;  // of this tick
  Approach approach_;    // of plan_
  std::optional<MovingPose> approached_;     // the target that it follows
  std::optional<std::string> plan_refusal_;  // the planner's last answer had no plan
  std::optional<Stamp> last_seen_;           // last measurement of the target
  std::optional<Stamp> tracked_since_;
  std::optional<Pose> setpoint_;
  double cursor_ = 0;
};

}  // namespace prf_decision
