// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/shadow_arm.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <vector>

namespace prf_decision {
namespace {

constexpr Duration kHandsKept = std::chrono::seconds(1);  // older images are not asked about

// The rest as in arm_controller.yaml.
prf_control::FollowerParams follower_params(const ArmLimits& limits) {
  limits.validate();
  prf_control::FollowerParams params{};
  params.velocity_scale = limits.velocity_scale;
  params.acceleration = limits.acceleration;
  params.max_joint_step = 0.3;
  params.far_position = 0.1;
  params.far_orientation = 0.5;
  params.damping = 0.1;
  params.orientation_weight = 0.2;
  params.branch_patience = 1.0;
  return params;
}

bool same(const Pose& a, const Pose& b) {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

}  // namespace

void ArmLimits::validate() const {
  prf_core::require_between("arm_limits[0]", velocity_scale, 0.01, 1);
  prf_core::require_between("arm_limits[1]", acceleration, 0.1, 20, "rad/s^2");
}

ShadowArm::ShadowArm(const ArmLimits& limits) : follower_(limits.arm, follower_params(limits)) {}

void ShadowArm::set_goal(const Pose& goal_in_target) {
  if (goal_in_target_ && same(*goal_in_target_, goal_in_target)) return;
  goal_in_target_ = goal_in_target;
  begin_anew();
}

void ShadowArm::begin_anew() {
  follower_.reset();
  hands_.clear();
  seen_.clear();
}

void ShadowArm::step(Stamp tick, Duration dt, Duration lead, const TargetForecast* forecast,
                     const std::optional<prf_control::JointVector>& joints) {
  if (!goal_in_target_ || dt <= Duration{0}) return;
  if (forecast) {
    const MovingPose goal = prf_core::rigidly_attached(
        predicted_target(*forecast, tick + lead).target, *goal_in_target_);
    const prf_control::PoseSetpoint setpoint{goal.pose.isometry(), goal.linear_velocity,
                                             goal.angular_velocity};
    if (!follower_.started()) {
      if (!joints) return;
      const auto begin = follower_.arm().inverse(setpoint.hand_in_base, *joints);
      if (!begin.solved) return;
      follower_.start(begin.q);
    }
    follower_.follow(setpoint, to_seconds(dt));
  } else if (follower_.started()) {
    follower_.hold(to_seconds(dt));
  }
  if (!follower_.started()) return;
  hands_.push_back(
      {tick + lead, follower_.arm().forward(follower_.state().position).translation()});
  while (hands_.front().stamp + kHandsKept < hands_.back().stamp) hands_.pop_front();
}

std::optional<double> ShadowArm::deviation(const TargetForecast& seen) const {
  const bool tracked = seen.status == TargetStatus::kTracking && !seen.predictions.empty();
  if (!tracked || !goal_in_target_ || hands_.empty()) return std::nullopt;
  const auto after =
      std::lower_bound(hands_.begin(), hands_.end(), seen.stamp,
                       [](const Sample& one, Stamp stamp) { return one.stamp < stamp; });
  if (after == hands_.end() || (after == hands_.begin() && after->stamp > seen.stamp)) {
    return std::nullopt;
  }
  Eigen::Vector3d hand = after->hand;
  if (after->stamp > seen.stamp) {
    const auto before = after - 1;
    const double fraction =
        to_seconds(seen.stamp - before->stamp) / to_seconds(after->stamp - before->stamp);
    hand = before->hand + fraction * (after->hand - before->hand);
  }
  const Pose& target = seen.predictions[0].target.pose;
  const double distance =
      (target.position + target.orientation * goal_in_target_->position - hand).norm();
  return std::isfinite(distance) ? std::optional(distance) : std::nullopt;
}

std::optional<double> ShadowArm::observe(const TargetForecast& seen) {
  if (!seen_.empty() && seen.stamp - seen_.back().stamp > kGap) begin_anew();
  const auto found = deviation(seen);
  if (found) seen_.push_back({seen.stamp, *found});
  while (!seen_.empty() && seen_.front().stamp + kWindow < seen.stamp) seen_.pop_front();
  return found;
}

std::optional<double> ShadowArm::holdable() const {
  if (seen_.size() < kLeastImages) return std::nullopt;
  std::vector<double> deviations;
  deviations.reserve(seen_.size());
  for (const Seen& one : seen_) deviations.push_back(one.deviation);
  const auto rank = std::lround(kShare * static_cast<double>(deviations.size() - 1));
  std::nth_element(deviations.begin(), deviations.begin() + rank, deviations.end());
  return deviations[static_cast<std::size_t>(rank)];
}

std::optional<Eigen::Vector3d> ShadowArm::hand() const {
  return hands_.empty() ? std::nullopt : std::optional(hands_.back().hand);
}

}  // namespace prf_decision
