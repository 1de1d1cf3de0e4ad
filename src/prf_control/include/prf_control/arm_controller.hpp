// SPDX-License-Identifier: BSD-3-Clause
// The arm controller without ROS: joint samples and set-points in, in any interleaving; one answer
// per tick out, in order, a function of the data alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "prf_control/setpoint_follower.hpp"
#include "prf_control/tick_joiner.hpp"

namespace prf_control {

struct ArmControllerParams {
  FollowerParams follower;
  double
      max_tracking_error;    // [rad], > 0; measured farther from the command: start anew from there
  double max_wait;           // [s], > 0; of data time, for a set-point and between two ticks
  std::string joint_prefix;  // joints are called <prefix>1 .. <prefix>7 in the reasons

  void validate() const;
};

enum class ControlCode : std::uint8_t {  // as prf_msgs/ControlStatus
  kFollowing = 0,
  kHolding = 1,
  kLimited = 2,
  kUnreachable = 3,
  kStaleSetpoint = 4,
  kInvalidSetpoint = 5
};

struct Answer {
  std::int64_t stamp_ns = 0;
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
  std::uint64_t refused_jumps = 0;
  std::uint64_t branch_changing = 0;  // ticks
  std::uint64_t restarts = 0;
};

class ArmController {
 public:
  explicit ArmController(const ArmControllerParams& params);

  // Another share of the velocity limits, and acceleration limit, from the next tick on.
  void tune(double velocity_scale, double acceleration);

  std::vector<Answer> add_joints(const JointSample& joints);
  std::vector<Answer> add_setpoint(std::int64_t stamp_ns, const Setpoint& setpoint);

  [[nodiscard]] const ControllerCounts& counts() const { return counts_; }
  [[nodiscard]] const JoinerCounts& joiner_counts() const { return joiner_.counts(); }

 private:
  std::vector<Answer> decided();
  // None while no finite joint positions have been seen.
  std::optional<Answer> answer(const JoinedTick& tick);
  std::string restart_reason(const JoinedTick& tick, double dt) const;
  void restart(const JointVector& measured, const std::string& reason, Answer& answer);
  void serve(const JoinedTick& tick, double dt, Answer& answer);
  void follow(const PoseSetpoint& setpoint, double dt, Answer& answer);
  [[nodiscard]] std::string describe(const FollowerStep& step) const;
  [[nodiscard]] std::string name(int joint) const;

  ArmControllerParams params_;
  TickJoiner joiner_;
  SetpointFollower follower_;
  std::optional<std::int64_t> last_stamp_ns_;
  ControllerCounts counts_;
};

}  // namespace prf_control
