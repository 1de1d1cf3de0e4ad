// SPDX-License-Identifier: BSD-3-Clause
// Records how the robot moves on the platform while its arm is held still.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "platform_sim/headless.hpp"
#include "platform_sim/put_robot.hpp"

namespace {

using platform_sim::World;

struct Recording {
  prf_robots::Robot robot;
  platform_sim::WorldParams config;
  double duration = 40.0;  // s
  int rate = 100;          // Hz
  std::string out;
};

// The options of the command line; throws CLI::ParseError.
Recording read_options(CLI::App& app, int argc, char** argv) {
  Recording recording;
  recording.config.motion = "light";
  recording.config.seed = 1;
  app.add_option("--out", recording.out, "CSV file to write")->required();
  std::string robot = "jaco_v60";
  app.add_option("--robot", robot, "one of prf_robots, or the path of a folder like those")
      ->capture_default_str();
  app.add_option("--motion", recording.config.motion, "of the platform")->capture_default_str();
  app.add_option("--gait", recording.config.gait)->capture_default_str();
  app.add_option("--seed", recording.config.seed)->capture_default_str();
  app.add_option("--body-motion", recording.config.body_motion, "CSV file that carries the base");
  app.add_option("--duration", recording.duration, "s")->capture_default_str();
  app.add_option("--rate", recording.rate, "samples a second, divides 1000")->capture_default_str();
  app.parse(argc, argv);
  recording.robot = platform_sim::put_robot(robot, &recording.config);
  return recording;
}

std::string header_of(const Recording& recording, const World& world) {
  const std::string& base = recording.robot.base_link;
  std::ostringstream header;
  header << "# recorded by: rosrun platform_sim record_motion\n"
         << "# motion: " << recording.config.motion << "\n"
         << "# body_motion: " << recording.config.body_motion << "\n"
         << "# gait: " << recording.config.gait << "\n"
         << "# seed: " << recording.config.seed << "\n"
         << "# rate_hz: " << recording.rate << "\n"
         << "# fallen: " << (world.fallen() ? "true" : "false") << "\n"
         << "# tag: pose in " << base << "\n"
         << "# base: pose of " << world.base_link() << " in platform\n"
         << "# hand: pose of " << recording.robot.tip_link << " in " << base << "\n"
         << "# camera: pose of " << recording.robot.camera_frame << " in " << base << "\n"
         << "# platform: pose in world\n"
         << "# units: s, m, unit quaternion with w >= 0\n"
         << "time";
  for (const char* pose : {"tag", "base", "hand", "camera", "platform"}) {
    for (const char* part : {"x", "y", "z", "qx", "qy", "qz", "qw"}) {
      header << "," << pose << "_" << part;
    }
  }
  header << "\n";
  return header.str();
}

void append_pose(const Eigen::Isometry3d& pose, std::string& row) {
  const Eigen::Vector3d p = pose.translation();
  Eigen::Quaterniond q(pose.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  char text[200];
  std::snprintf(text, sizeof(text), ",%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f", p.x(), p.y(), p.z(),
                q.x(), q.y(), q.z(), q.w());
  row += text;
}

std::string row_of(const World& world, const prf_robots::Robot& robot) {
  char time[32];
  std::snprintf(time, sizeof(time), "%.3f", world.time());
  std::string row = time;
  const Eigen::Isometry3d platform = world.platform().pose;
  const Eigen::Isometry3d to_arm_base = world.frame(robot.base_link).pose.inverse();
  append_pose(to_arm_base * world.tag().pose, row);
  append_pose(platform.inverse() * world.base().pose, row);
  append_pose(to_arm_base * world.frame(robot.tip_link).pose, row);
  append_pose(to_arm_base * world.frame(robot.camera_frame).pose, row);
  append_pose(platform, row);
  return row + "\n";
}

// Not before the first sample: until then an argument may be refused.
void open(const std::string& path, std::ofstream& file) {
  file.open(path);
  if (!file)
    throw std::invalid_argument(
        "--out = " + path +
        " cannot be written: is its folder there, and may this user write to it?");
}

// Returns whether the robot is still on its feet.
bool record(const Recording& recording) {
  World world(recording.robot.urdf, recording.config);
  std::ofstream file;
  std::string rows;
  const auto begin = std::chrono::steady_clock::now();
  platform_sim::run_headless(world, recording.duration, recording.rate, [&](const World& now) {
    if (!file.is_open()) open(recording.out, file);
    rows += row_of(now, recording.robot);
  });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  file << header_of(recording, world) << rows;
  file.close();
  if (!file)
    throw std::runtime_error(
        recording.out + " cannot be written: is its folder there, and may this user write to it?");
  std::printf("%.2f s simulated in %.2f s\n", world.time(), wall.count());
  if (world.fallen()) {
    std::cerr << "record_motion: the robot fell at " << world.time() << " s\n";
  }
  return !world.fallen();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Simulates the robot with its arm held at the ready pose, without ROS, and writes poses."};
  try {
    constexpr int kFallen = 1;
    return record(read_options(app, argc, argv)) ? 0 : kFallen;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "record_motion: " << error.what() << "\n";
    return 2;
  }
}
