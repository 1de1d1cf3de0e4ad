// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "platform_sim/variation.hpp"

namespace platform_sim {
namespace {

template <class Value>
[[noreturn]] void refuse(const std::string& name, const Value& value, const std::string& bound) {
  std::ostringstream message;
  message << name << " = " << value << ", must be " << bound;
  throw std::invalid_argument(message.str());
}

void require_within(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream bound;
  bound << "in " << low << ".." << high;
  refuse(name, value, bound.str());
}

std::string one_of(const std::string& name, const std::string& value,
                   const std::vector<std::string>& allowed) {
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) return value;
  std::string bound = "one of";
  for (const std::string& word : allowed) bound += " " + word;
  refuse(name, value, bound);
}

camera_sim::HandCameraConfig read_camera(prf_ros::PrivateParameters& values) {
  camera_sim::HandCameraConfig camera;
  const std::vector<double> distortion = values.numbers("distortion", 5);
  std::copy(distortion.begin(), distortion.end(), camera.optics.distortion.begin());
  camera.timing.latency = values.number("latency");
  camera.timing.exposure = values.number("exposure");
  camera.noise = values.number("noise");
  camera.light_change = values.number("light_change");
  camera.light_period = values.number("light_period");
  camera.clutter = values.integer("clutter");
  values.refuse_unknown();
  try {
    camera.validate();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("camera: ") + error.what());
  }
  return camera;
}

}  // namespace

SimParameters read_parameters(prf_ros::PrivateParameters values) {
  SimParameters result;
  result.world.motion = values.text("motion");
  result.world.body_motion = values.text("body_motion");
  result.world.scenario =
      one_of("scenario", values.text("scenario"), WorldConfig::scenario_names());
  result.world.gait = one_of("gait", values.text("gait"), World::gait_names());
  const int seed = values.integer("seed");
  require_within("seed", seed, 0, 2147483647);
  result.world.seed = static_cast<std::uint64_t>(seed);
  const Variation variation = Variation::draw(result.world.seed, values.number("variation"));
  variation.apply_to(result.world);
  result.variation = variation.text();
  result.world.arm_mode =
      one_of("arm_mode", values.text("arm_mode"), {"servo", "compliant"}) == "servo"
          ? ArmMode::kServo
          : ArmMode::kCompliant;
  result.world.arm_latency = values.number("arm_latency");
  const std::vector<double> start = values.numbers("initial_positions", 7);
  for (std::size_t i = 0; i < start.size(); ++i) {
    require_within("initial_positions[" + std::to_string(i) + "]", start[i], -2.0 * M_PI,
                   2.0 * M_PI);
    result.world.arm_start[static_cast<Eigen::Index>(i)] = start[i];
  }
  result.lockstep = values.flag("lockstep");
  result.paused = values.flag("paused");
  result.answer_timeout = values.number("answer_timeout");
  require_within("answer_timeout", result.answer_timeout, 0.1, 3600.0);
  result.real_time_factor = values.number("real_time_factor");
  require_within("real_time_factor", result.real_time_factor, 0.0, 1000.0);
  result.time_limit = values.number("time_limit");
  require_within("time_limit", result.time_limit, 0.01, 86400.0);
  result.end_delay = values.number("end_delay");
  require_within("end_delay", result.end_delay, 0.0, 60.0);
  prf_ros::PrivateParameters camera = values.section("camera");
  result.camera = read_camera(camera);
  result.camera.seed = result.world.seed;
  result.camera.noise *= variation.camera_noise_factor;
  values.refuse_unknown();
  result.world.validate();
  return result;
}

}  // namespace platform_sim
