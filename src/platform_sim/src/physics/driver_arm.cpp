// SPDX-License-Identifier: BSD-3-Clause
#include "driver_arm.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>

namespace platform_sim {
namespace {

using Takes = DriverModel::Takes;

// Of a velocity loop: with only a proportional part the arm would sink while it stands.
constexpr double kIntegralGain = 20.0;   // 1/s
constexpr double kLongestWindUp = 0.05;  // rad
constexpr double kTimeTolerance = 1e-6;  // s, rounding of sums of milliseconds

}  // namespace

DriverArm::DriverArm(BulletScene& scene, RobotModel& robot, const std::vector<std::string>& joints,
                     const DriverModel& model)
    : robot_(robot), time_step_(scene.time_step()), model_(model) {
  for (const std::string& name : joints) {
    const v60_gait::RobotJoint& joint = robot.joint(name);
    prf_core::require_positive("velocity limit of " + name, joint.max_velocity, "rad/s");
    prf_core::require_positive("effort limit of " + name, joint.max_effort, "Nm");
    joints_.push_back(&joint);
    motors_.push_back(std::make_unique<JointMotor>(scene, robot, joint));
  }
  halt();
}

ArmVector DriverArm::measured() const {
  ArmVector positions(static_cast<Eigen::Index>(joints_.size()));
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    positions[static_cast<Eigen::Index>(i)] = robot_.position(*joints_[i]);
  }
  return positions;
}

void DriverArm::send(const DriverPoint& point, double time) {
  queue_.push_back({point, time});
  if (queue_.size() > model_.queue) queue_.pop_front();
}

void DriverArm::halt() {
  queue_.clear();
  const ArmVector now = measured();
  taken_ = DriverPoint{now, ArmVector::Zero(now.size()), 0.0};
  from_ = {taken_.positions, taken_.velocities};
  integral_ = taken_.positions;
}

void DriverArm::take(double time) {
  const auto is_due = [&] {
    return !queue_.empty() && time - queue_.front().time >= model_.latency - kTimeTolerance;
  };
  if (model_.take_period > 0.0) {
    const auto period = std::lround(1000.0 * model_.take_period);
    if (std::lround(1000.0 * time) % period != 0 || !is_due()) return;
    begin(queue_.front().point, time);
    queue_.pop_front();
    return;
  }
  while (is_due()) {
    begin(queue_.front().point, time);
    queue_.pop_front();
  }
}

void DriverArm::begin(const DriverPoint& point, double time) {
  from_ = desired(time);
  taken_ = point;
  taken_at_ = time;
}

// Cubic Hermite polynomial over s = 0 .. 1.
DriverArm::Desired DriverArm::desired(double time) const {
  const double duration = taken_.duration;
  const double s = duration > 0.0 ? (time - taken_at_) / duration : 1.0;
  if (!(s < 1.0)) return {taken_.positions, ArmVector::Zero(taken_.positions.size())};
  const ArmVector step = taken_.positions - from_.positions;
  const ArmVector v0 = duration * from_.velocities;
  const ArmVector v1 = duration * taken_.velocities;
  const ArmVector c2 = 3.0 * step - 2.0 * v0 - v1;
  const ArmVector c3 = v0 + v1 - 2.0 * step;
  return {from_.positions + s * (v0 + s * (c2 + s * c3)),
          (v0 + s * (2.0 * c2 + 3.0 * s * c3)) / duration};
}

void DriverArm::update(double time) {
  take(time);
  ArmVector velocity = ArmVector::Zero(taken_.positions.size());
  if (model_.takes == Takes::kVelocities) {
    const bool lasts = model_.lifetime == 0.0 || time - taken_at_ < model_.lifetime;
    if (lasts) velocity = taken_.velocities;
    const ArmVector now = measured();
    integral_ = (integral_ + time_step_ * velocity)
                    .cwiseMax(now - ArmVector::Constant(now.size(), kLongestWindUp))
                    .cwiseMin(now + ArmVector::Constant(now.size(), kLongestWindUp));
    velocity += kIntegralGain * (integral_ - now);
  } else {
    const Desired wanted =
        model_.takes == Takes::kPositions ? Desired{taken_.positions, velocity} : desired(time);
    velocity = wanted.velocities + model_.servo_gain * (wanted.positions - measured());
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double limit = joints_[i]->max_velocity;
    motors_[i]->drive(std::clamp(velocity[static_cast<Eigen::Index>(i)], -limit, limit),
                      joints_[i]->max_effort);
  }
}

Eigen::VectorXd DriverArm::efforts() const {
  Eigen::VectorXd torques(motors_.size());
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    torques[static_cast<Eigen::Index>(i)] = motors_[i]->torque();
  }
  return torques;
}

}  // namespace platform_sim
