// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/command_adapter.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/bounds.hpp>
#include <prf_core/require.hpp>
#include <sstream>

namespace prf_drivers {
namespace {

using Eigen::VectorXd;

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kMaxVelocity = 50.0;  // rad/s, far beyond any arm

const AdapterParams& validated(const AdapterParams& params) {
  params.validate();
  return params;
}

// The shorter way round: the gate of the controller keeps commands near the measured joints.
VectorXd error_between(const VectorXd& to, const VectorXd& from) {
  return (to - from).unaryExpr([](double error) { return std::remainder(error, kTwoPi); });
}

}  // namespace

void AdapterParams::validate() const {
  using prf_core::require_between;
  require_between("period", period, 0.001, 0.1, "s");
  require_between("delay", delay, 0.0, 0.5, "s");
  require_between("gain", gain, 0.0, 50.0, "1/s");
  require_between("command_timeout", command_timeout, 0.01, 1.0, "s");
  require_between("max_distance", max_distance, 0.01, 1.0, "rad");
  require_between("braking", braking, 0.1, 100.0, "rad/s^2");
  prf_core::require(max_velocity.size() > 0, "max_velocity", "empty", "one for each joint");
  for (const double limit : max_velocity) {
    prf_core::require_positive_up_to("max_velocity", limit, kMaxVelocity, "rad/s");
  }
}

CommandAdapter::CommandAdapter(const AdapterParams& params, std::shared_ptr<MotionGuard> guards)
    : params_(validated(params)),
      guards_(std::move(guards)),
      joiner_({prf_core::from_seconds(params.command_timeout)}),
      position_(VectorXd::Zero(params.max_velocity.size())),
      velocity_(VectorXd::Zero(params.max_velocity.size())) {}

void CommandAdapter::set_speed(double speed) {
  prf_core::require_between("speed", speed, 0.0, 1.0);
  speed_ = speed;
}

std::vector<DriverCommand> CommandAdapter::add_measured(prf_core::Stamp stamp,
                                                        const Measured& measured) {
  const prf_core::StampOrder order = joiner_.advance(stamp);
  if (!prf_core::is_accepted(order)) return {};
  if (order == prf_core::StampOrder::kBackwardJump) {
    ++counts_.new_runs;
    history_.clear();
    begun_ = false;
    velocity_.setZero();
    if (guards_) guards_->reset();
  }
  joiner_.push_primary(stamp, measured);
  return decided();
}

std::vector<DriverCommand> CommandAdapter::add_command(prf_core::Stamp stamp,
                                                       const VectorXd& position,
                                                       const VectorXd& velocity,
                                                       const std::string& refusal) {
  const prf_core::StampOrder order = joiner_.push_secondary(stamp, {position, velocity, refusal});
  if (order != prf_core::StampOrder::kNewer) ++counts_.late_commands;
  return decided();
}

std::vector<DriverCommand> CommandAdapter::decided() {
  std::vector<DriverCommand> results;
  while (const auto tick = joiner_.pop()) {
    if (auto result = process(*tick)) results.push_back(*std::move(result));
  }
  return results;
}

std::optional<DriverCommand> CommandAdapter::process(const Joiner::Joined& tick) {
  ++counts_.ticks;
  const std::string why = reason_to_hold(tick);
  if (tick.secondary && !why.empty() && why != veto_) ++counts_.refused_commands;
  if (!why.empty()) {
    std::optional<DriverCommand> held = hold(why);
    if (held) held->stamp = tick.stamp;
    return held;
  }
  return follow(*tick.secondary, tick.primary, tick.stamp);
}

std::string CommandAdapter::reason_to_hold(const Joiner::Joined& tick) const {
  if (!veto_.empty()) return veto_;
  if (!(speed_ > 0.0)) return "the operator's speed is 0";
  if (!tick.secondary) return "no command for this tick";
  const Command& command = *tick.secondary;
  if (!command.refusal.empty()) return command.refusal;
  const auto joints = params_.max_velocity.size();
  if (command.position.size() != joints || command.velocity.size() != joints ||
      !prf_core::is_within(command.position, prf_core::kMaxJointPosition) ||
      !prf_core::is_within(command.velocity, prf_core::kMaxAngularSpeed)) {
    return "the command is not finite or beyond all bounds";
  }
  const VectorXd& measured = tick.primary.position;
  if (measured.size() != joints || !prf_core::is_within(measured, prf_core::kMaxJointPosition)) {
    return "the measured joints are not known";
  }
  const double away = distance(command.position, measured);
  if (away <= params_.max_distance) return "";
  std::ostringstream text;
  text << "the command is " << away << " rad from the measured joints, at most "
       << params_.max_distance << " is followed";
  return text.str();
}

double CommandAdapter::distance(const VectorXd& commanded, const VectorXd& measured) const {
  return error_between(commanded, measured).cwiseAbs().maxCoeff();
}

VectorXd CommandAdapter::expected_at(prf_core::Stamp stamp) const {
  const prf_core::Stamp then = stamp - prf_core::from_seconds(params_.delay);
  const auto after =
      std::find_if(history_.begin(), history_.end(),
                   [then](const Commanded& commanded) { return commanded.stamp >= then; });
  if (after == history_.end()) return history_.back().position;
  if (after == history_.begin()) return after->position;
  const auto before = std::prev(after);
  const double share = prf_core::to_seconds(then - before->stamp) /
                       prf_core::to_seconds(after->stamp - before->stamp);
  return before->position + share * error_between(after->position, before->position);
}

void CommandAdapter::remember(prf_core::Stamp stamp, const VectorXd& position) {
  history_.push_back({stamp, position});
  const prf_core::Stamp then = stamp - prf_core::from_seconds(params_.delay);
  while (history_.size() > 2 && history_[1].stamp < then) history_.pop_front();
}

CommandAdapter::Motion CommandAdapter::motion(const Command& command, const VectorXd& measured,
                                              prf_core::Stamp stamp, double speed) const {
  const VectorXd& limit = params_.max_velocity;
  const auto slowed = [&limit, speed](const VectorXd& velocity) -> VectorXd {
    const VectorXd clamped = velocity.cwiseMax(-limit).cwiseMin(limit);
    const double share = clamped.cwiseAbs().cwiseQuotient(limit).maxCoeff();
    return share > speed ? VectorXd(speed / share * clamped) : clamped;
  };
  if (params_.takes == Takes::kVelocities) {
    const VectorXd error = error_between(expected_at(stamp), measured);
    return {command.position, slowed(command.velocity + params_.gain * error)};
  }
  // What begins anew begins at the measured joints; so it does in another turn of a joint.
  const bool turned = (command.position - position_).cwiseAbs().maxCoeff() > params_.max_distance;
  const VectorXd from = !begun_ || turned ? measured : position_;
  const VectorXd step = params_.period * slowed((command.position - from) / params_.period);
  return {from + step, slowed(command.velocity)};
}

VectorXd CommandAdapter::rest_after(const Motion& motion, const VectorXd& measured) const {
  VectorXd rest = measured + (params_.delay + params_.period) * motion.velocity;
  if (params_.takes == Takes::kPositions) rest = motion.position;
  return rest + motion.velocity.cwiseProduct(motion.velocity.cwiseAbs()) / (2.0 * params_.braking);
}

DriverCommand CommandAdapter::follow(const Command& command, const Measured& measured,
                                     prf_core::Stamp stamp) {
  remember(stamp, command.position);
  Motion sent = motion(command, measured.position, stamp, speed_);
  Allowance allowed;
  if (guards_) {
    allowed = guards_->allow({stamp, measured, rest_after(sent, measured.position)});
    if (allowed.hold) {
      // Before the first motion the arm is held where it is.
      if (!begun_) position_ = measured.position;
      begun_ = true;
      DriverCommand held = *hold(allowed.why);
      held.stamp = stamp;
      held.code = allowed.code;
      return held;
    }
  }
  const double speed = std::min(speed_, allowed.speed);
  if (!(speed >= speed_)) sent = motion(command, measured.position, stamp, speed);
  position_ = sent.position;
  velocity_ = sent.velocity;
  begun_ = true;
  return {stamp, position_, velocity_, "", allowed.code, speed, allowed.why};
}

std::optional<DriverCommand> CommandAdapter::hold(const std::string& why) {
  if (!begun_) return std::nullopt;
  ++counts_.held;
  brake();
  history_.clear();
  return DriverCommand{prf_core::Stamp{0}, position_, velocity_, why,
                       MotionCode::kHeld,  speed_,    ""};
}

void CommandAdapter::brake() {
  const double change = params_.braking * params_.period;
  velocity_ = velocity_.unaryExpr([change](double velocity) {
    return std::abs(velocity) <= change ? 0.0 : velocity - std::copysign(change, velocity);
  });
  position_ += params_.period * velocity_;
}

}  // namespace prf_drivers
