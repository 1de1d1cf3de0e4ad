// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "camera_sim/target_box.hpp"
#include "platform_sim/driver_model.hpp"

namespace platform_sim {

/// The parts of the robot description that the world has to know.
struct RobotParts {
  std::vector<std::string> arm_joints;  ///< from base to hand, 1 to 8
  std::string hand;                     ///< link that the arm moves
  bool on_legs = true;                  ///< of the Vision 60; else bolted to the platform

  /// Throws std::invalid_argument with name and bound.
  void validate() const;
};

enum class ArmMode {
  kServo,      ///< velocity-limited position servos, see command_arm()
  kCompliant,  ///< gravity compensated and back-drivable, to be guided by the hand
};

struct WorldParams {
  /// treadmill: the box is fixed to the platform; cart: it is on a cart on the floor, which a hand
  /// pushes aside (once by CartPush::draw(), else as `disturb` says), and motion must be none;
  /// quay: it stands in the world, and the robot alone is on the platform.
  std::string scenario = "treadmill";
  std::string obstacle =
      "none";                   ///< post: one stands in the way of a hand that comes from the side
  std::string motion = "none";  ///< see find_profile()
  std::string body_motion;      ///< CSV file: carries base_link over the deck; empty: legs do
  std::string disturb;          ///< see Disturbances
  std::string gait = "stand";   ///< one of gait_names()
  std::uint64_t seed =
      0;  ///< of the platform's phase, the cart's push, leg sensors and placing errors
  double friction = 0.8;         ///< Coulomb coefficient of all robot contacts
  double base_start_x = -0.156;  ///< m, body centre, or the foot of a robot without legs, in the
                                 ///< platform frame at the start
  double base_start_y = 0.0;     ///< m
  double base_start_yaw = 0.0;   ///< rad
  ArmMode arm_mode = ArmMode::kServo;
  RobotParts robot;
  ArmVector arm_start;        ///< rad
  double servo_gain = 20.0;   ///< 1/s, velocity per position error of an arm joint
  double arm_latency = 0.02;  ///< s, from a command to the arm's servos; chosen by hand
  /// Of ArmMode::kServo: the arm does what this driver is sent, see command_driver(); none: it
  /// takes command_arm().
  std::optional<DriverModel> driver;
  camera_sim::TargetBox target;

  [[nodiscard]] static const std::vector<std::string>& scenario_names();
  [[nodiscard]] bool target_stands_ashore() const;
  [[nodiscard]] static const std::vector<std::string>& obstacle_names();
  /// The target as the scenario places it.
  [[nodiscard]] camera_sim::TargetBox placed_target() const;
  /// Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

}  // namespace platform_sim
