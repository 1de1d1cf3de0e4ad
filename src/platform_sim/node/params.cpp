// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <stdexcept>

#include "platform_sim/put_robot.hpp"
#include "platform_sim/variation.hpp"

namespace platform_sim {
namespace {

std::string one_of(const std::string& name, const std::string& value,
                   const std::vector<std::string>& allowed) {
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return value;
  std::string bound = "one of";
  for (const std::string& word : allowed) bound += " " + word;
  prf_core::require(false, name, value, bound);
  return value;
}

DriverModel read_driver_model(prf_ros::PrivateParameters values) {
  const std::string takes = one_of("driver_model/takes", values.text("takes"),
                                   {"velocities", "positions", "trajectories"});
  DriverModel model;
  model.takes = takes == "velocities"  ? DriverModel::Takes::kVelocities
                : takes == "positions" ? DriverModel::Takes::kPositions
                                       : DriverModel::Takes::kTrajectories;
  model.latency = values.number("latency");
  model.take_period = values.number("take_period");
  const int queue = values.integer("queue");
  prf_core::require(queue >= 1, "driver_model/queue", queue, ">= 1");
  model.queue = static_cast<std::size_t>(queue);
  model.lifetime = values.number("lifetime");
  model.servo_gain = values.number("servo_gain");
  values.refuse_unknown();
  return model;
}

camera_sim::HandCameraParams read_camera(prf_ros::PrivateParameters& values) {
  camera_sim::HandCameraParams camera;
  const std::vector<double> distortion = values.numbers("distortion", 5);
  std::copy(distortion.begin(), distortion.end(), camera.optics.distortion.begin());
  camera.timing.latency = values.number("latency");
  camera.timing.exposure = values.number("exposure");
  camera.noise = values.number("noise");
  camera.light_change = values.number("light_change");
  camera.light_period = values.number("light_period");
  camera.clutter = values.integer("clutter");
  values.refuse_unknown();
  return camera;
}

}  // namespace

void SimParams::validate() const {
  prf_core::require_between("response_timeout", response_timeout, 0.1, 3600.0, "s");
  prf_core::require_between("patience", patience, 0.0, response_timeout, "s");
  if (real_time_factor != 0.0) {
    prf_core::require_between("real_time_factor", real_time_factor, 0.001, 1000.0);
  }
  prf_core::require_between("time_limit", time_limit, 0.01, 86400.0, "s");
  prf_core::require_between("end_delay", end_delay, 0.0, 86400.0, "s");
  try {
    camera.validate();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("camera: ") + error.what());
  }
  world.validate();
}

SimParams load_params(prf_ros::PrivateParameters values, const ros::NodeHandle& node) {
  SimParams result;
  result.world.motion = values.text("motion");
  result.world.disturb = values.text("disturb");
  result.world.body_motion = values.text("body_motion");
  result.world.scenario =
      one_of("scenario", values.text("scenario"), WorldParams::scenario_names());
  result.world.obstacle =
      one_of("obstacle", values.text("obstacle"), WorldParams::obstacle_names());
  result.world.gait = one_of("gait", values.text("gait"), World::gait_names());
  const int seed = values.integer("seed");
  prf_core::require(seed >= 0, "seed", seed, ">= 0");
  result.world.seed = static_cast<std::uint64_t>(seed);
  const Variation variation = Variation::draw(result.world.seed, values.number("variation"));
  variation.apply_to(result.world);
  result.variation = variation.text();
  result.world.arm_mode =
      one_of("arm_mode", values.text("arm_mode"), {"servo", "compliant"}) == "servo"
          ? ArmMode::kServo
          : ArmMode::kCompliant;
  if (values.flag("with_driver")) {
    result.driver = load_driver_names(prf_ros::PrivateParameters(ros::NodeHandle(node, "driver")));
    result.world.driver = read_driver_model(values.section("driver_model"));
  }
  result.world.arm_latency = values.number("arm_latency");
  put_robot(values.text("robot"), &result.world);
  result.lockstep = values.flag("lockstep");
  result.paused = values.flag("paused");
  result.response_timeout = values.number("response_timeout");
  result.patience = values.number("patience");
  result.real_time_factor = values.number("real_time_factor");
  result.time_limit = values.number("time_limit");
  result.end_delay = values.number("end_delay");
  prf_ros::PrivateParameters camera = values.section("camera");
  result.camera = read_camera(camera);
  result.camera.seed = result.world.seed;
  result.camera.noise *= variation.camera_noise_factor;
  values.refuse_unknown();
  result.validate();
  return result;
}

}  // namespace platform_sim
