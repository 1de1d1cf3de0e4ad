// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include <Eigen/Core>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "multibody_from_urdf.hpp"
#include "platform_sim/driver_model.hpp"

namespace platform_sim {

/// Velocity motor of one joint: drives to a velocity with at most the torque it is given.
class JointMotor {
 public:
  JointMotor(BulletScene& scene, RobotModel& robot, const v60_gait::RobotJoint& joint);
  ~JointMotor();
  JointMotor(const JointMotor&) = delete;
  JointMotor& operator=(const JointMotor&) = delete;

  void drive(double velocity, double max_torque);
  /// Torque of the last step, Nm.
  [[nodiscard]] double torque() const;

 private:
  BulletScene& scene_;
  std::unique_ptr<btMultiBodyJointMotor> motor_;
};

/// What moves an arm's joints. A drive takes commands, messages of a driver or wrenches; what it
/// does not take throws std::invalid_argument.
class ArmDrive {
 public:
  virtual ~ArmDrive() = default;
  /// Positions, rad, and velocities, rad/s, to be reached from `time`, s, on.
  virtual void command(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities,
                       double time);
  /// A message to the driver, from `time`, s, on, and an end to all that it was sent.
  virtual void send(const DriverPoint& point, double time);
  virtual void halt();
  /// Force, N, and torque, Nm, on the hand in world axes, held until the next call.
  virtual void apply_hand_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque);
  /// To be called before each physics step.
  virtual void update(double time) = 0;
  /// Torques of the last step, Nm.
  [[nodiscard]] virtual Eigen::VectorXd efforts() const = 0;
};

/// Position servos: dq = clamp(dq_command + gain (q_command - q), +-dq_max), at most the joint's
/// torque: a first-order lag of 1/gain where no velocity is commanded. Joints without position
/// limits take the shorter way round.
///
/// Commands wait in a queue as in the arm's driver: each for `latency` at least, and one is taken
/// every 10 ms. Sent faster than that they pile up, of 2000 the oldest is lost.
class ArmServo : public ArmDrive {
 public:
  /// Throws std::invalid_argument if a joint has no velocity or effort limit.
  ArmServo(BulletScene& scene, RobotModel& robot, const std::vector<std::string>& joints,
           double gain, double latency);

  /// Queues a command. Taken, it holds `positions`; `velocities` lapse 20 ms later.
  void command(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities,
               double time) override;
  void update(double time) override;
  [[nodiscard]] Eigen::VectorXd efforts() const override;

 private:
  struct Command {
    Eigen::VectorXd positions;
    Eigen::VectorXd velocities;
    double time = 0.0;
  };

  void take_command(double time);

  RobotModel& robot_;
  double gain_;
  double latency_;
  std::deque<Command> queue_;
  std::vector<const v60_gait::RobotJoint*> joints_;
  std::vector<std::unique_ptr<JointMotor>> motors_;
  Eigen::VectorXd positions_;
  Eigen::VectorXd velocities_;
  double taken_ = 0.0;  // s, when the command in force was taken
};

/// Back-drivable arm: torques balance gravity, motors only brake with dry and viscous friction.
class CompliantArm : public ArmDrive {
 public:
  CompliantArm(BulletScene& scene, RobotModel& robot, const std::vector<std::string>& joints,
               const std::string& hand_link);

  void apply_hand_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) override;
  void update(double time) override;
  [[nodiscard]] Eigen::VectorXd efforts() const override;

 private:
  RobotModel& robot_;
  std::string hand_link_;
  std::vector<const v60_gait::RobotJoint*> joints_;
  std::vector<std::unique_ptr<JointMotor>> brakes_;
  Eigen::VectorXd gravity_balance_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_ = Eigen::Vector3d::Zero();
};

}  // namespace platform_sim
