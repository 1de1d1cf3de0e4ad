// SPDX-License-Identifier: BSD-3-Clause
// The arm controller without ROS: measured joints and set-points in, joint commands out.
//
// Each set of measured joints is a control tick. It is joined with the set-point of the same stamp
// (tick_joiner.hpp), and the follower (setpoint_follower.hpp) computes the command of that tick.
// One call may return no result or several. The results come in the order of the ticks and depend
// only on the data, not on how the two streams interleave.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "prf_control/setpoint_follower.hpp"
#include "prf_control/tick_joiner.hpp"

namespace prf_control {

struct ArmControllerParams {
  FollowerParams follower;
  double max_tracking_error;  // [rad], > 0; a measured joint farther than this from its command
                              // makes the command start again from the measured joints
  double max_wait;            // [s], > 0; data time: for a set-point, and between two ticks
  std::string joint_prefix;   // in the reasons, joints are called <prefix>1 .. <prefix>7

  void validate() const;
};

enum class ControlCode : std::uint8_t {  // as prf_msgs/ControlStatus
  kFollowing = 0,
  kHolding = 1,  // asked for, or the measured joints are not finite, or a restart
  kLimited = 2,
  kUnreachable = 3,
  kStaleSetpoint = 4,  // the tick has no set-point, also when none has ever come
  kInvalidSetpoint = 5
};

struct ControlResult {
  prf_core::Stamp stamp{0};  // of the tick
  ControlCode code = ControlCode::kHolding;
  std::string reason;
  MotionState command;
  double position_error = 0.0;     // [m], set-point (holding: command) to measured hand
  double orientation_error = 0.0;  // [rad]
  double deviation = 0.0;          // [m], set-point to commanded hand; 0 when holding
  bool restarted = false;          // the command was set to the measured joints
};

struct ControllerCounts {
  std::uint64_t ticks = 0;
  std::uint64_t faulty_joints = 0;
  std::uint64_t invalid_setpoints = 0;
  std::uint64_t refused_jumps = 0;    // ticks at which a change of branch was refused
  std::uint64_t branch_changing = 0;  // ticks at which the arm changed branch
  std::uint64_t restarts = 0;
};

class ArmController {
 public:
  // Throws std::invalid_argument for parameters that validate() refuses.
  explicit ArmController(const ArmControllerParams& params);

  // Another share of the velocity limits and another acceleration limit, from the next tick on.
  // Throws std::invalid_argument for values that FollowerParams::validate() refuses.
  void tune(double velocity_scale, double acceleration);

  std::vector<ControlResult> add_joints(const JointSample& joints);
  std::vector<ControlResult> add_setpoint(prf_core::Stamp stamp, const Setpoint& setpoint);

  [[nodiscard]] const ControllerCounts& counts() const { return counts_; }
  [[nodiscard]] const JoinerCounts& joiner_counts() const { return joiner_.counts(); }

 private:
  std::vector<ControlResult> process_joined_ticks();
  // None while no finite joint positions have been seen.
  std::optional<ControlResult> process(const TickJoiner::Joined& tick);
  std::string restart_reason(const TickJoiner::Joined& tick, double dt) const;
  void restart(const JointVector& measured, const std::string& reason, ControlResult& result);
  void follow_or_hold(const TickJoiner::Joined& tick, double dt, ControlResult& result);
  void follow(const PoseSetpoint& setpoint, double dt, ControlResult& result);
  [[nodiscard]] std::string describe(const FollowerStep& step) const;
  [[nodiscard]] std::string name(int joint) const;

  ArmControllerParams params_;
  TickJoiner joiner_;
  SetpointFollower follower_;
  std::optional<prf_core::Stamp> last_stamp_;
  ControllerCounts counts_;
};

}  // namespace prf_control
