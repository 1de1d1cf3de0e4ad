// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace v60_gait {

/// Order: fl, fr, rl, rr (front and rear, left and right); within a leg abduction, hip, knee.
using LegVector = Eigen::Matrix<double, 12, 1>;

/// All inputs of a leg controller: encoders, inertial unit and the operator's joystick.
struct LegObservation {
  double time = 0.0;                         ///< s; below 0 while the robot settles
  LegVector positions = LegVector::Zero();   ///< rad
  LegVector velocities = LegVector::Zero();  ///< rad/s
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< base_link in world
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();    ///< rad/s, in base_link
  Eigen::Vector3d joystick = Eigen::Vector3d::Zero();  ///< desired velocity over the deck: m/s
                                                       ///< ahead, m/s to the left, rad/s of yaw
};

/// Locomotion controller of the quadruped, called at every physics step. It knows nothing of the
/// platform or the task; of the arm it knows what BodyModel (stance.hpp) tells.
class LegController {
 public:
  virtual ~LegController() = default;
  /// Joint torques, Nm, before the limits of the motors.
  [[nodiscard]] virtual LegVector torques(const LegObservation& observation) = 0;
};

}  // namespace v60_gait
