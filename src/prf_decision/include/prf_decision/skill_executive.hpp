// SPDX-License-Identifier: BSD-3-Clause
// Executes the skill: at every control tick it lets the belief (belief_tracker.hpp) and the guards
// (guards.hpp) drive the state machine (assessor.hpp, decision_fsm.hpp), and gives the set-point of
// the state (reference_generator.hpp). What counts as reached is judged by the measured hand
// (following_monitor.hpp).
#pragma once

#include <optional>
#include <prf_core/speed_scale.hpp>
#include <string>

#include "prf_decision/assessor.hpp"
#include "prf_decision/belief_tracker.hpp"
#include "prf_decision/execution_fsm.hpp"
#include "prf_decision/following_monitor.hpp"
#include "prf_decision/guards.hpp"
#include "prf_decision/plan_receiver.hpp"
#include "prf_decision/reference_generator.hpp"
#include "prf_decision/view/target_search.hpp"

namespace prf_decision {

struct DecisionParams {
  bool autostart = true;   // the first execution begins without a goal
  Duration hold_time{0};   // the target must be tracked for this long
  Duration dwell_time{0};  // least time in a state before the HMM may change it
  Duration time_limit{0};  // from the execution's first tick
  ReferenceParams reference;
  GuardParams guards;
  HmmParams hmm;
  ArmLimits arm;
  SearchParams search;

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

// One request of the action execute_skill.
struct SkillGoal {
  Duration time_limit{0};          // 0: as in the parameters
  Duration hold_time{0};           // 0: as in the parameters
  bool resume = false;             // from where the cursor stands; else back to the start first
  std::string demonstration = {};  // as the planner reads it; empty: the one accepted before

  void validate() const;
};

struct Progress {
  Stamp stamp{0};
  Stamp forecast_stamp{0};  // 0: none yet
  ExecutionState state = ExecutionState::kWaiting;
  Event cause = Event::kHazard;  // the event that led into the state
  std::string reason;            // why the state holds; may be empty
  Eigen::Vector3d posterior = Eigen::Vector3d::Zero();
  double cursor = 0;
  double fraction = 0;     // of the skill executed, 0 .. 1
  std::size_t frozen = 0;  // nodes
  Duration time_to_go{0};
  std::optional<GoalDistance> goal_distance;  // of the measured hand, to where the skill ends now
  std::optional<PoseError> following;         // measured hand from its set-point; none: it holds
  std::optional<double> holdable;             // of the target's motion, m; shadow_arm.hpp
  NamedDemonstration demonstration;           // that the planner shall follow
  std::string refusal;  // why the requested demonstration is not switched to, at this tick
};

struct ExecutiveResult {
  Progress progress;
  std::optional<MovingPose> setpoint;  // none: hold
};

class SkillExecutive {
 public:
  // Validates the parameters.
  explicit SkillExecutive(const DecisionParams& params);

  [[nodiscard]] ExecutiveResult update(const Tick& tick);

  // A goal can be given when no execution is under way. It begins with the next tick. A goal that
  // names a demonstration begins when the planner has accepted that; when it is refused the goal
  // does not begin and Progress::refusal says why. begin() throws std::invalid_argument when
  // can_begin() is false or the goal is not valid.
  [[nodiscard]] bool can_begin() const { return !goals_.next && fsm_.can_begin(); }
  void begin(const SkillGoal& goal);
  // Whether a goal waits for the planner to accept its demonstration.
  [[nodiscard]] bool is_requesting() const { return plans_.demonstration().is_requested(); }

  // Stops whatever is under way at the next tick, in any state.
  void preempt() { goals_.preempt_requested = true; }

  // Other parameters from the next tick on. Those for adaptation, autostart and the HMM are
  // ignored; running executions keep their time limit and hold time. Throws what validate()
  // refuses.
  void tune(const DecisionParams& params);

  // How fast the cursor and the catching up are from a tick on, as a share; throws as
  // prf_core::SpeedScale. What moves with the target is not slowed down.
  void scale_speed(Stamp from, double scale) { speed_.announce(from, scale); }

  // How often the HMM's posterior was no distribution and was reset.
  [[nodiscard]] std::size_t belief_resets() const { return belief_.resets(); }
  // What keeps the arm from following; empty: nothing.
  [[nodiscard]] const std::string& following_trouble() const { return following_.trouble(); }

  // The whole state in one line, for logs.
  [[nodiscard]] std::string describe() const;

 private:
  struct Goals {
    std::optional<SkillGoal> next;  // that is to begin
    SkillGoal current;              // under way or ended
    Stamp began{0};
    bool preempt_requested = false;
    std::string refusal;  // of this tick
  };
  [[nodiscard]] bool adapts_once() const {
    return params_.reference.adaptation == Adaptation::kOnce;
  }
  [[nodiscard]] bool moves_arm() const;
  [[nodiscard]] bool can_search(const Tick& tick) const;
  void receive_plan(const PlanResult& result);
  void end_unanswered_request(Stamp stamp);
  void begin_execution(Stamp stamp);
  void switch_demonstration();
  void begin_search(const Tick& tick);
  [[nodiscard]] GuardInput guard_input(const Tick& tick) const;
  [[nodiscard]] AssessmentInput assessment_input(const Tick& tick) const;
  void change_state(const Tick& tick, const Assessment& assessment);
  [[nodiscard]] const TargetForecast* followed_forecast(const Tick& tick) const;
  [[nodiscard]] std::optional<MovingPose> move(const Tick& tick, bool violation);
  [[nodiscard]] std::optional<Pose> look(const Tick& tick);
  void step_shadow(const Tick& tick);
  [[nodiscard]] Progress progress(const Tick& tick) const;

  DecisionParams params_;
  BeliefTracker belief_;
  ShadowArm shadow_;
  PlanReceiver plans_;
  FollowingMonitor following_;
  Assessor assessor_;
  ExecutionFsm fsm_;
  ReferenceGenerator reference_;
  TargetSearch search_;
  Goals goals_;
  prf_core::SpeedScale speed_;
  std::optional<Stamp> last_tick_;
  std::optional<Pose> last_setpoint_;  // of that tick; none: the arm held
};

}  // namespace prf_decision
