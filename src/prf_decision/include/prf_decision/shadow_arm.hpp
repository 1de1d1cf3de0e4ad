// SPDX-License-Identifier: BSD-3-Clause
// What this arm could do with the target as it moves: a shadow of the arm stands at the goal of the
// skill and follows the target, by the controller's own follower and within its limits, whatever
// the real arm does meanwhile. How far the shadow's hand is off its goal is what the limits cost:
//
//   set-point at tick t    goal_in_target on the target predicted for t + lead
//   hand at t + lead       forward(command at t): the lead makes up for the arm's lag
//   deviation at image c   distance of the hand at c from goal_in_target on the target seen at c
//
// Metres, seconds; poses are in the planning frame.
#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <prf_control/setpoint_follower.hpp>

#include "prf_decision/types.hpp"

namespace prf_decision {

struct ArmLimits {
  double velocity_scale = 0;  // share of the joints' velocity limits, 0.01 .. 1
  double acceleration = 0;    // rad/s^2 of every joint, 0.1 .. 20
  prf_control::Arm arm;

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

class ShadowArm {
 public:
  // The motion that holdable() speaks of.
  static constexpr Duration kWindow = std::chrono::seconds(4);
  static constexpr double kShare = 0.95;
  static constexpr std::size_t kLeastImages = 15;
  // After a longer gap between images of the target it begins anew: its way to where the target is
  // then says nothing of the motion.
  static constexpr Duration kGap = std::chrono::milliseconds(500);

  explicit ShadowArm(const ArmLimits& limits);

  // Where the hand shall be in the target's frame. Another one than before begins anew.
  void set_goal(const Pose& goal_in_target);

  // One tick, `dt` after the one before. Null: no forecast that may be followed, the shadow stands.
  // It begins at the first goal that the arm can reach, in the joint positions nearest to `joints`.
  void step(Stamp tick, Duration dt, Duration lead, const TargetForecast* forecast,
            const std::optional<prf_control::JointVector>& joints);

  // Of the hand at the stamp of a forecast whose target is tracked; none: not known.
  [[nodiscard]] std::optional<double> deviation(const TargetForecast& seen) const;

  // deviation(), kept for holdable(); none after a gap.
  std::optional<double> observe(const TargetForecast& seen);

  // What the arm can hold here: the deviation that was not exceeded in kShare of the images of the
  // last kWindow; none: too few.
  [[nodiscard]] std::optional<double> holdable() const;

  // The hand `lead` after the last tick; none: not begun.
  [[nodiscard]] std::optional<Eigen::Vector3d> hand() const;

 private:
  struct Sample {
    Stamp stamp{0};
    Eigen::Vector3d hand = Eigen::Vector3d::Zero();
  };
  struct Seen {
    Stamp stamp{0};
    double deviation = 0;
  };

  void begin_anew();

  prf_control::SetpointFollower follower_;
  std::optional<Pose> goal_in_target_;
  std::deque<Sample> hands_;
  std::deque<Seen> seen_;
};

}  // namespace prf_decision
