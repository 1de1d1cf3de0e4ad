// SPDX-License-Identifier: BSD-3-Clause
// A robot is a folder: robot.urdf, made from robot.urdf.xacro, and robot.yaml, which says what of
// it is the arm. README.md has the keys.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace prf_robots {

using arm_kinematics::JointVector;

struct Robot {
  std::string folder;
  std::string urdf;      // the text of robot.urdf
  bool on_legs = false;  // of the Vision 60; else bolted to the deck
  std::string base_link;
  std::string tip_link;
  std::string camera_frame;
  std::vector<std::string> joints;  // from base to tip
  Eigen::Vector3d shoulder;         // [m] in base_link: centre of what the tip reaches
  double reach = 0.0;               // [m] of the tip from the shoulder, arm straight: its radius
  JointVector ready;                // [rad] or [m]
  std::optional<JointVector> jerk;  // [rad/s^3] or [m/s^3] of each joint
  double driver_period = 0.0;       // [s]
  std::shared_ptr<const arm_kinematics::ArmKinematics> kinematics;
};

// The folder of a robot of this package, or `name_or_path` itself if there is a / in it.
// std::invalid_argument, with the names that there are, for any other.
[[nodiscard]] std::string robot_folder(const std::string& name_or_path);

// The names of the robots of this package, sorted.
[[nodiscard]] std::vector<std::string> robot_names();

// Throws std::invalid_argument in one line with file, key, value and what is allowed: for a file
// that cannot be read, an unknown or missing key, a value of another kind or out of bounds, links
// or joints that are not the URDF's, and what chain_from_urdf() refuses.
[[nodiscard]] Robot load_robot(const std::string& folder);

}  // namespace prf_robots
