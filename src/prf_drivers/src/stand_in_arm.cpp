// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/stand_in_arm.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/bounds.hpp>
#include <prf_core/require.hpp>

namespace prf_drivers {
namespace {

using Eigen::VectorXd;

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kMaxVelocity = 50.0;  // rad/s, far beyond any arm
constexpr std::size_t kMostCommands = 1000;

VectorXd error_between(const VectorXd& to, const VectorXd& from) {
  return (to - from).unaryExpr([](double error) { return std::remainder(error, kTwoPi); });
}

}  // namespace

void StandInParams::validate() const {
  prf_core::require_between("delay", delay, 0.0, 0.5, "s");
  prf_core::require(max_velocity.size() > 0, "max_velocity", "empty", "one for each joint");
  for (const double limit : max_velocity) {
    prf_core::require_positive_up_to("max_velocity", limit, kMaxVelocity, "rad/s");
  }
}

StandInArm::StandInArm(const StandInParams& params) : params_(params) { params_.validate(); }

std::optional<StandInState> StandInArm::at(prf_core::Stamp stamp, const VectorXd& measured) {
  const prf_core::StampOrder order = clock_.observe(stamp);
  if (!prf_core::is_accepted(order)) return std::nullopt;
  if (order == prf_core::StampOrder::kBackwardJump) {
    commands_.clear();
    position_.reset();
  }
  const double dt = last_ && stamp > *last_ ? prf_core::to_seconds(stamp - *last_) : 0.0;
  last_ = stamp;
  const bool known = measured.size() == params_.max_velocity.size() &&
                     prf_core::is_within(measured, prf_core::kMaxJointPosition);
  if (commands_.empty() || !position_) {
    if (!known) return std::nullopt;
    position_ = measured;
    return StandInState{measured, VectorXd::Zero(measured.size())};
  }
  const VectorXd step = dt * params_.max_velocity;
  const VectorXd motion =
      error_between(commanded_at(stamp - prf_core::from_seconds(params_.delay)), *position_)
          .cwiseMax(-step)
          .cwiseMin(step);
  *position_ += motion;
  const VectorXd velocity = dt > 0.0 ? VectorXd(motion / dt) : VectorXd::Zero(motion.size());
  return StandInState{*position_, velocity};
}

bool StandInArm::command(prf_core::Stamp stamp, const VectorXd& position) {
  if (position.size() != params_.max_velocity.size() ||
      !prf_core::is_within(position, prf_core::kMaxJointPosition)) {
    return false;
  }
  if (!commands_.empty() && stamp <= commands_.back().stamp) return false;
  if (commands_.size() >= kMostCommands) commands_.pop_front();
  commands_.push_back({stamp, position});
  return true;
}

VectorXd StandInArm::commanded_at(prf_core::Stamp stamp) const {
  const auto after = std::find_if(commands_.begin(), commands_.end(),
                                  [stamp](const Commanded& one) { return one.stamp >= stamp; });
  if (after == commands_.end()) return commands_.back().position;
  if (after == commands_.begin()) return after->position;
  const auto before = std::prev(after);
  const double share = prf_core::to_seconds(stamp - before->stamp) /
                       prf_core::to_seconds(after->stamp - before->stamp);
  return before->position + share * error_between(after->position, before->position);
}

}  // namespace prf_drivers
