// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/put_robot.hpp"

#include "prf_core/require.hpp"

namespace platform_sim {
namespace {

const std::string kCamera = "camera_optical_frame";  // that of camera_sim

}  // namespace

prf_robots::Robot put_robot(const std::string& name_or_path, WorldParams* config) {
  prf_robots::Robot robot = prf_robots::load_robot(prf_robots::robot_folder(name_or_path));
  prf_core::require(robot.camera_frame == kCamera, robot.folder + "/robot.yaml: camera_frame",
                    robot.camera_frame, kCamera + " in the simulator");
  config->robot = {robot.joints, robot.tip_link, robot.on_legs};
  config->arm_start = robot.ready;
  return robot;
}

}  // namespace platform_sim
