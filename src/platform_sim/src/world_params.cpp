// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/world_params.hpp"

#include <algorithm>
#include <stdexcept>

#include "motion/body_motion.hpp"
#include "platform_sim/disturbances.hpp"
#include "platform_sim/platform_motion.hpp"
#include "prf_core/quoted.hpp"
#include "prf_core/require.hpp"
#include "v60_gait/gaits.hpp"

namespace platform_sim {
namespace {

const std::string kCart = "cart";
const std::string kQuay = "quay";
const std::string kPost = "post";

void require_body_motion(const std::string& path) {
  try {
    const BodyMotion readable(path);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("body_motion is '" + path + "': " + error.what());
  }
}

}  // namespace

void DriverModel::validate() const {
  prf_core::require_between("driver_model/latency", latency, 0.0, 0.2, "s");
  prf_core::require_between("driver_model/take_period", take_period, 0.0, 0.1, "s");
  prf_core::require(queue >= 1 && queue <= 10000, "driver_model/queue", queue, "within [1, 10000]");
  prf_core::require_between("driver_model/lifetime", lifetime, 0.0, 10.0, "s");
  const bool has_servo = takes != Takes::kVelocities;
  prf_core::require_between("driver_model/servo_gain", servo_gain, has_servo ? 0.1 : 0.0, 500.0,
                            "1/s");
}

void RobotParts::validate() const {
  const std::size_t count = arm_joints.size();
  prf_core::require(count >= 1 && count <= ArmVector::MaxSizeAtCompileTime, "arm_joints", count,
                    "1 to 8 names");
  prf_core::require(!hand.empty(), "hand", "''", "the name of a link");
}

const std::vector<std::string>& WorldParams::scenario_names() {
  static const std::vector<std::string> names{"treadmill", kCart, kQuay};
  return names;
}

bool WorldParams::target_stands_ashore() const { return scenario == kQuay; }

const std::vector<std::string>& WorldParams::obstacle_names() {
  static const std::vector<std::string> names{"none", kPost};
  return names;
}

camera_sim::TargetBox WorldParams::placed_target() const {
  camera_sim::TargetBox placed = target;
  placed.on_cart = scenario == kCart;
  placed.obstructed = obstacle == kPost;
  return placed;
}

void WorldParams::validate() const {
  const std::vector<std::string>& scenarios = scenario_names();
  if (std::find(scenarios.begin(), scenarios.end(), scenario) == scenarios.end()) {
    throw std::invalid_argument("scenario is '" + scenario + "', must be treadmill, cart or quay");
  }
  if (scenario == kCart && motion != "none") {
    throw std::invalid_argument(
        "motion is '" + motion +
        "', must be none in the scenario cart, where nothing moves the floor");
  }
  const std::vector<std::string>& obstacles = obstacle_names();
  if (std::find(obstacles.begin(), obstacles.end(), obstacle) == obstacles.end()) {
    throw std::invalid_argument("obstacle is '" + obstacle + "', must be none or post");
  }
  if (obstacle == kPost && scenario != "treadmill") {
    throw std::invalid_argument("obstacle is 'post', must be none but in the scenario treadmill");
  }
  const PlatformMotion deck_motion(motion, seed);
  if (Disturbances(disturb, seed).moves_cart() && scenario != kCart) {
    throw std::invalid_argument("disturb is " + prf_core::quoted(disturb) +
                                ", a cart can be pushed in the scenario cart only");
  }
  if (!body_motion.empty()) require_body_motion(body_motion);
  v60_gait::require_gait(gait);
  if (gait != "stand" && (deck_motion.carries_base() || !body_motion.empty())) {
    throw std::invalid_argument("gait is '" + gait + "', must be stand when the base is carried");
  }
  prf_core::require_between("friction", friction, 0.05, 2.0);
  prf_core::require_between("base_start_x", base_start_x, -0.4, 0.2, "m");
  prf_core::require_between("base_start_y", base_start_y, -0.3, 0.3, "m");
  prf_core::require_between("base_start_yaw", base_start_yaw, -0.5, 0.5, "rad");
  prf_core::require_between("servo_gain", servo_gain, 0.1, 200.0, "1/s");
  prf_core::require_between("arm_latency", arm_latency, 0.0, 0.2, "s");
  if (driver) driver->validate();
  robot.validate();
  prf_core::require(arm_start.size() == static_cast<Eigen::Index>(robot.arm_joints.size()),
                    "arm_start's size", arm_start.size(), std::to_string(robot.arm_joints.size()));
  for (int i = 0; i < arm_start.size(); ++i) {
    prf_core::require_between("arm_start[" + std::to_string(i) + "]", arm_start[i], -7.0, 7.0,
                              "rad");
  }
  placed_target().validate();
}

}  // namespace platform_sim
