// SPDX-License-Identifier: BSD-3-Clause
#include "arm_servo.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <stdexcept>

namespace platform_sim {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
// As in the driver of the Jaco2 (kinova-ros) the queue holds 2000 points, and one is taken every
// 10 ms. The lifetime, two such periods, is chosen by hand.
constexpr double kVelocityLifetime = 0.02;  // s
constexpr long kTakePeriodMs = 10;
constexpr std::size_t kLongestQueue = 2000;
constexpr double kTimeTolerance = 1e-6;  // s, rounding of sums of milliseconds
// Chosen by hand for a guided joint: a hand moves the arm easily, and it stops when it is let go.
constexpr double kDryFriction = 0.1;      // Nm
constexpr double kViscousFriction = 1.0;  // Nm s/rad

Eigen::VectorXd torques_of(const std::vector<std::unique_ptr<JointMotor>>& motors) {
  Eigen::VectorXd torques(motors.size());
  for (std::size_t i = 0; i < motors.size(); ++i) {
    torques[static_cast<Eigen::Index>(i)] = motors[i]->torque();
  }
  return torques;
}

}  // namespace

void ArmDrive::command(const Eigen::VectorXd&, const Eigen::VectorXd&, double) {
  throw std::invalid_argument("command_arm needs arm_mode kServo");
}

void ArmDrive::send(const DriverPoint&, double) {
  throw std::invalid_argument("command_driver needs a driver");
}

void ArmDrive::halt() { throw std::invalid_argument("halt_driver needs a driver"); }

void ArmDrive::apply_hand_wrench(const Eigen::Vector3d&, const Eigen::Vector3d&) {
  throw std::invalid_argument("apply_hand_wrench needs arm_mode kCompliant");
}

JointMotor::JointMotor(BulletScene& scene, RobotModel& robot, const v60_gait::RobotJoint& joint)
    : scene_(scene),
      motor_(
          std::make_unique<btMultiBodyJointMotor>(&robot.multibody(), joint.body - 1, 0.0, 0.0)) {
  scene_.world().addMultiBodyConstraint(motor_.get());
}

JointMotor::~JointMotor() { scene_.world().removeMultiBodyConstraint(motor_.get()); }

void JointMotor::drive(double velocity, double max_torque) {
  motor_->setVelocityTarget(velocity);
  motor_->setMaxAppliedImpulse(max_torque * scene_.time_step());
}

double JointMotor::torque() const { return motor_->getAppliedImpulse(0) / scene_.time_step(); }

ArmServo::ArmServo(BulletScene& scene, RobotModel& robot, const std::vector<std::string>& joints,
                   double gain, double latency)
    : robot_(robot), gain_(gain), latency_(latency) {
  positions_.resize(static_cast<Eigen::Index>(joints.size()));
  for (const std::string& name : joints) {
    const v60_gait::RobotJoint& joint = robot.joint(name);
    prf_core::require_positive("velocity limit of " + name, joint.max_velocity, "rad/s");
    prf_core::require_positive("effort limit of " + name, joint.max_effort, "Nm");
    positions_[static_cast<Eigen::Index>(joints_.size())] = robot.position(joint);
    joints_.push_back(&joint);
    motors_.push_back(std::make_unique<JointMotor>(scene, robot, joint));
  }
  velocities_ = Eigen::VectorXd::Zero(positions_.size());
}

void ArmServo::command(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities,
                       double time) {
  queue_.push_back({positions, velocities, time});
  if (queue_.size() > kLongestQueue) queue_.pop_front();
}

void ArmServo::take_command(double time) {
  if (std::lround(time * 1000.0) % kTakePeriodMs != 0 || queue_.empty()) return;
  if (time - queue_.front().time < latency_ - kTimeTolerance) return;
  positions_ = queue_.front().positions;
  velocities_ = queue_.front().velocities;
  taken_ = time;
  queue_.pop_front();
}

void ArmServo::update(double time) {
  take_command(time);
  const bool is_fresh = time - taken_ < kVelocityLifetime;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const v60_gait::RobotJoint& joint = *joints_[i];
    const auto index = static_cast<Eigen::Index>(i);
    double error = positions_[index] - robot_.position(joint);
    if (!joint.has_position_limits) error = std::remainder(error, kTwoPi);
    const double feed_forward = is_fresh ? velocities_[index] : 0.0;
    const double velocity =
        std::clamp(feed_forward + gain_ * error, -joint.max_velocity, joint.max_velocity);
    motors_[i]->drive(velocity, joint.max_effort);
  }
}

Eigen::VectorXd ArmServo::efforts() const { return torques_of(motors_); }

CompliantArm::CompliantArm(BulletScene& scene, RobotModel& robot,
                           const std::vector<std::string>& joints, const std::string& hand_link)
    : robot_(robot), hand_link_(hand_link) {
  for (const std::string& name : joints) {
    joints_.push_back(&robot.joint(name));
    brakes_.push_back(std::make_unique<JointMotor>(scene, robot, *joints_.back()));
  }
  gravity_balance_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(joints.size()));
}

void CompliantArm::apply_hand_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
  force_ = force;
  torque_ = torque;
}

// A brake is a motor toward standstill with little torque: unlike an explicit damping torque it
// cannot overshoot however small the link's inertia is.
void CompliantArm::update(double /*time*/) {
  const Eigen::VectorXd gravity = robot_.gravity_torques();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const v60_gait::RobotJoint& joint = *joints_[i];
    const double balance = -gravity[joint.body - 1];
    gravity_balance_[static_cast<Eigen::Index>(i)] = balance;
    robot_.apply_torque(joint, balance);
    const double speed = std::abs(robot_.velocity(joint));
    brakes_[i]->drive(0.0, kDryFriction + kViscousFriction * speed);
  }
  robot_.apply_wrench(hand_link_, force_, torque_);
}

Eigen::VectorXd CompliantArm::efforts() const { return gravity_balance_ + torques_of(brakes_); }

}  // namespace platform_sim
