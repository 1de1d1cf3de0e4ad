// SPDX-License-Identifier: BSD-3-Clause
// The arm controller without ROS: measured joints and set-points in, joint commands out.
//
// Each set of measured joints is a control tick. It is joined with the set-point of the same stamp
// (tick_joiner.hpp), and the follower (setpoint_follower.hpp) computes the command of that tick.
// One call may return no result or several. The results come in the order of the ticks and depend
// only on the data, not on how the two streams interleave.
//
// Where the arm is decides: every command passes pass_gate() (command_gate.hpp) in process(), and
// so is never farther from the measured joints than max_tracking_error and one tick's motion. The
// command begins anew from the measured joints, at rest, when they are farther than
// max_tracking_error from it, at the first tick of a run and after a leap of the ticks. Measured
// joints outside their limits: the arm stays there while it holds, goes back inside slowly to
// follow a set-point, and is not moved when they are farther outside than kFarOutside (kFailing).
#pragma once

#include <cstdint>
#include <optional>
#include <prf_core/speed_scale.hpp>
#include <string>
#include <vector>

#include "prf_control/setpoint_follower.hpp"
#include "prf_control/tick_joiner.hpp"

namespace prf_control {

struct ArmControllerParams {
  FollowerParams follower;
  double max_tracking_error;  // [rad], 0.01 to 1; of a measured joint to its command
  double max_wait;            // [s], 0.02 to 5; data time: for a set-point, and between two ticks
  std::vector<std::string> joints;  // names from base to hand, for the reasons

  void validate() const;
};

// [rad] Mechanical stops do not let a joint so far: its encoder is wrong, or it is another arm.
inline constexpr double kFarOutside = 0.35;

enum class ControlCode : std::uint8_t {  // as prf_msgs/ControlStatus
  kFollowing = 0,
  kHolding = 1,  // asked for, or the command begins anew
  kLimited = 2,
  kUnreachable = 3,
  kStaleSetpoint = 4,  // the tick has no set-point, also when none has ever come
  kInvalidSetpoint = 5,
  kFailing = 6  // the measured joints cannot be used, or the gate refused the command
};

struct ControlResult {
  prf_core::Stamp stamp{0};  // of the tick
  ControlCode code = ControlCode::kHolding;
  std::string reason;
  std::optional<MotionState> command;  // none while no joint positions have been known
  // [m], [rad] Set-point (without one: command) to the measured hand. Where this tick's joints
  // cannot be used, to the last known hand; nan before any.
  double position_error = 0.0;
  double orientation_error = 0.0;
  double deviation = 0.0;  // [m], set-point to commanded hand; 0 when holding
  bool restarted = false;  // the command was set to the measured joints
};

struct ControllerCounts {
  std::uint64_t ticks = 0;
  std::uint64_t faulty_joints = 0;     // ticks whose joints could not be used
  std::uint64_t other_turns = 0;       // ticks at which a continuous joint was reported in another
                                       // turn than commanded; the command followed
  std::uint64_t refused_commands = 0;  // by the gate; 0 unless the controller has a defect
  std::uint64_t invalid_setpoints = 0;
  std::uint64_t refused_jumps = 0;    // ticks at which a change of branch was refused
  std::uint64_t branch_changing = 0;  // ticks at which the arm changed branch
  std::uint64_t restarts = 0;
};

struct Reasons;

class ArmController {
 public:
  // Throws std::invalid_argument for parameters that validate() refuses, without an arm, and for
  // another number of names than the arm has joints.
  ArmController(Arm arm, const ArmControllerParams& params);

  // Another share of the velocity limits and another acceleration limit, from the next tick on.
  // Throws std::invalid_argument for values that FollowerParams::validate() refuses.
  void tune(double velocity_scale, double acceleration);
  // A share of velocity_scale from a tick on; throws as prf_core::SpeedScale.
  void scale_speed(prf_core::Stamp from, double scale) { speed_.announce(from, scale); }

  std::vector<ControlResult> add_joints(const JointSample& joints);
  std::vector<ControlResult> add_setpoint(prf_core::Stamp stamp, const Setpoint& setpoint);

  [[nodiscard]] const ControllerCounts& counts() const { return counts_; }
  [[nodiscard]] const JoinerCounts& joiner_counts() const { return joiner_.counts(); }

 private:
  struct Tick;
  void apply_speed(prf_core::Stamp tick);
  std::vector<ControlResult> process_joined_ticks();
  ControlResult process(const TickJoiner::Joined& joined);
  Tick tick_of(const TickJoiner::Joined& joined);
  void follow_into_turn(const JointVector& measured);
  std::string restart_reason(const Tick& tick) const;
  void restart(const Tick& tick, const std::string& reason, ControlResult& result);
  void follow_or_hold(const Tick& tick, ControlResult& result);
  void follow(const PoseSetpoint& setpoint, double dt, ControlResult& result);
  void hold(const Tick& tick, ControlResult& result);
  void pass_gate(const Tick& tick, const std::optional<MotionState>& last, ControlResult& result);
  void measure_error(const Tick& tick, const std::optional<MotionState>& last,
                     ControlResult& result) const;
  [[nodiscard]] Reasons reasons() const;
  [[nodiscard]] const JointLimits& joint_limits() const { return follower_.arm().limits(); }

  ArmControllerParams params_;
  TickJoiner joiner_;
  SetpointFollower follower_;
  prf_core::SpeedScale speed_;
  double applied_speed_ = 1.0;
  std::optional<prf_core::Stamp> last_stamp_;
  std::optional<JointVector> measured_;  // the last known, unwrapped
  ControllerCounts counts_;
};

}  // namespace prf_control
