// SPDX-License-Identifier: BSD-3-Clause
// Looks for a target that is out of sight. The hand looks first at c, where the target was forecast
// last, then at places around it, across the line of sight, in loops that are each wider by
// `spacing`. It only turns: moving aside, to see into the box from elsewhere, touched the box where
// the target was believed to be elsewhere. With d from the stand to c, place j of loop k is
//
//   off c      o = d tan(rho),  rho = k spacing s(theta_j), toward the azimuth theta_j
//   s(theta)   sqrt(u' C u / largest), at least kSlimmest: C the covariance of c across the line of
//              sight, u the unit vector of theta; so the loops are longest where c is least certain
//
// and anew from c when the widest is through. The places of a loop are about `spacing` apart, seen
// from the stand. One is left out when the arm has no joint position for it, or only one that is
// far from where the joints are, and left when the hand is there, does not follow or takes longer
// than kPatience.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>
#include <memory>
#include <optional>

#include "prf_decision/types.hpp"

namespace prf_decision {

struct SearchParams {
  Duration time{0};    // after which the target counts as lost, parameter search[0]; 0: no search
  double spacing = 0;  // rad, of the loops and of the places of one, search[1]
  double widest = 0;   // rad, of a loop, search[2]
  std::shared_ptr<const arm_kinematics::ArmKinematics> arm;  // that looks

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

struct SearchInput {
  Stamp stamp{0};
  std::optional<Pose> hand;                           // as measured
  std::optional<arm_kinematics::JointVector> joints;  // that it was measured by, rad
  bool follows = true;                                // the arm does
};

class TargetSearch {
 public:
  static constexpr double kSlimmest = 0.5;
  static constexpr double kNear = 0.05;                           // m, of a look
  static constexpr double kThere = 0.1;                           // rad, of a look
  static constexpr double kFarthest = 1.5;                        // rad, of any joint to a look
  static constexpr Duration kPatience = std::chrono::seconds(3);  // with one look

  // `stand`: the hand at the start of the skill; `goal_in_target` tells how the camera looks from
  // it (view_keeper.hpp). `last`: the target as forecast last.
  void begin(const Pose& stand, const Pose& goal_in_target, const prf_core::TargetPrediction& last);

  // Where the hand shall be at this tick. Needs begin().
  [[nodiscard]] Pose look(const SearchParams& params, const SearchInput& input);

  // rad, by which the present look is off where the target was forecast.
  [[nodiscard]] double width() const { return width_; }

 private:
  struct Look {
    int loop = 0;
    int place = 0;
  };
  [[nodiscard]] Pose pose_of(const SearchParams& params, const Look& look) const;
  [[nodiscard]] double angle_of(const SearchParams& params, const Look& look) const;
  [[nodiscard]] Look after(const SearchParams& params, const Look& look) const;
  void go_on(const SearchParams& params, const SearchInput& input);

  Pose centre_;                                       // the hand that looks at c
  Eigen::Vector3d sight_ = Eigen::Vector3d::UnitX();  // from the stand to c, a unit vector
  double distance_ = 0;                               // m, to c
  Eigen::Vector3d major_ = Eigen::Vector3d::UnitY();  // across it, where c is least certain
  double slimness_ = 1;                               // of the loops, kSlimmest .. 1
  Look look_;
  std::optional<Stamp> since_;  // that this look holds
  Pose wanted_;
  double width_ = 0;
};

}  // namespace prf_decision
