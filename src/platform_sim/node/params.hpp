// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <prf_ros/private_parameters.hpp>

#include "camera_sim/hand_camera.hpp"
#include "driver_interface.hpp"
#include "platform_sim/world.hpp"

namespace platform_sim {

// The node's parameters; config/platform_sim.yaml says what each means.
struct SimParams {
  WorldParams world;
  std::string variation;  // what the seed drew, in words
  camera_sim::HandCameraParams camera;
  std::optional<DriverNames> driver;  // none: joint_command and joint_states
  bool lockstep = true;
  bool paused = false;
  double response_timeout = 0.0;  // s, wall time
  double patience = 0.0;          // s, wall time; 0: none
  double real_time_factor = 0.0;  // 0: none in lockstep, 1 otherwise
  double time_limit = 0.0;        // s
  double end_delay = 0.0;         // s

  // Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

// `node` has the block `driver` when the arm is moved by a driver. Throws std::invalid_argument
// with name, value and bound.
[[nodiscard]] SimParams load_params(prf_ros::PrivateParameters values, const ros::NodeHandle& node);

}  // namespace platform_sim
