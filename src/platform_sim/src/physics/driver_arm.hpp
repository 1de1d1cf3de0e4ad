// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "arm_servo.hpp"

namespace platform_sim {

/// The arm behind one of the drivers that robots have, see DriverModel:
///   velocities    joints move with what was taken last, until it lapses: q_d is its integral,
///                 dq = dq_taken + 20/s (q_d - q), as the integral part of a velocity loop does
///   positions     dq = gain (q_taken - q)
///   trajectories  q_d runs on a cubic polynomial from where it is to what was taken, within its
///                 duration, and stays there; dq = dq_d + gain (q_d - q)
/// each within the joints' velocity limits and with at most their torque. Before the first message
/// the arm stands. Positions are in the turn of the joint.
class DriverArm : public ArmDrive {
 public:
  /// Throws std::invalid_argument if a joint has no velocity or effort limit.
  DriverArm(BulletScene& scene, RobotModel& robot, const std::vector<std::string>& joints,
            const DriverModel& model);

  void send(const DriverPoint& point, double time) override;
  void halt() override;
  void update(double time) override;
  [[nodiscard]] Eigen::VectorXd efforts() const override;

 private:
  struct Waiting {
    DriverPoint point;
    double time = 0.0;
  };
  struct Desired {
    ArmVector positions;
    ArmVector velocities;
  };

  void take(double time);
  void begin(const DriverPoint& point, double time);
  [[nodiscard]] Desired desired(double time) const;
  [[nodiscard]] ArmVector measured() const;

  RobotModel& robot_;
  double time_step_;  // s
  DriverModel model_;
  std::vector<const v60_gait::RobotJoint*> joints_;
  std::vector<std::unique_ptr<JointMotor>> motors_;
  std::deque<Waiting> queue_;
  DriverPoint taken_;
  Desired from_;            // of a trajectory, when it began
  ArmVector integral_;      // rad, of the velocities
  double taken_at_ = -1e9;  // s
};

}  // namespace platform_sim
