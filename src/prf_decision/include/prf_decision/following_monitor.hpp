// SPDX-License-Identifier: BSD-3-Clause
// Watches whether the arm does what it is asked to: the measured hand against the set-point, and
// the reports of the arm controller. As path and goal tolerances of a trajectory controller:
//
//   following_tolerance   hand from the set-point, while it moves; beyond it the hand is off
//   goal_tolerance        the same at the goal: tracking and the start count only within it
//   following_limits      for how long the arm is off until it pauses, goes back, gives up
//
// The arm is off, too, when the hand is unknown, and when the controller fails or is silent. It has
// followed again once it was not off for following_limits[0]: a hand that is thrown to and fro
// across the bound does not follow. While the arm is moved, the time for which it is off adds up,
// and what it follows makes up for a quarter (kForgiven): so an arm that is off for more than a
// fifth of the time is given up, too, however often it pauses and goes back in between.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "prf_decision/lasting.hpp"
#include "prf_decision/types.hpp"

namespace prf_decision {

struct PoseTolerance {
  double position = 0;  // m
  double rotation = 0;  // rad

  // `name` is that of the parameter.
  void validate(const std::string& name) const;
};

struct FollowingParams {
  PoseTolerance path;  // following_tolerance
  PoseTolerance goal;  // goal_tolerance
  std::array<Duration, 3> limits{};

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

// What the arm controller reported last.
struct ControlReport {
  Stamp stamp{0};
  bool failing = false;  // no set-point is followed
  std::string reason;
};

struct PoseError {
  double position = 0;  // m
  double rotation = 0;  // rad

  [[nodiscard]] bool is_within(const PoseTolerance& tolerance) const {
    return position <= tolerance.position && rotation <= tolerance.rotation;
  }
};

[[nodiscard]] PoseError error_between(const Pose& a, const Pose& b);

struct FollowingInput {
  Stamp stamp{0};
  std::optional<Pose> setpoint;         // of the tick before; none: the arm held
  std::optional<Pose> hand;             // as measured at this tick
  std::optional<ControlReport> report;  // none yet
  bool controller_silent = false;
  bool is_moved = true;  // an execution moves the arm
};

class FollowingMonitor {
 public:
  static constexpr int kForgiven = 4;

  void update(const FollowingParams& params, const FollowingInput& input);

  // None: the hand is unknown, or there was no set-point.
  [[nodiscard]] const std::optional<PoseError>& error() const { return error_; }
  // Why the arm is off, or was last while that is not over; empty: it follows.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  // For how long it has been off; 0: it follows.
  [[nodiscard]] Duration lasting(Stamp stamp) const { return off_.time(stamp); }
  // For how long it has been off in all since it has been moved, less what is forgiven.
  [[nodiscard]] Duration off_in_all() const { return off_in_all_; }
  [[nodiscard]] bool is_off() const { return off_.is_on(); }
  // Whether the hand is where it shall be, as a goal demands: known, within the tolerance, and the
  // controller works.
  [[nodiscard]] bool is_on_goal() const { return on_goal_; }

 private:
  std::optional<PoseError> error_;
  std::string trouble_;
  Lasting off_;
  Duration off_in_all_{0};
  std::optional<Stamp> updated_;
  bool on_goal_ = false;
};

}  // namespace prf_decision
