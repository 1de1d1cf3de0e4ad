// SPDX-License-Identifier: BSD-3-Clause
// Says what a robot's folder holds, or in one line what is wrong with it (exit code 2).
#include <cstdio>
#include <exception>
#include <prf_robots/robot.hpp>
#include <string>

namespace {

void print(const prf_robots::Robot& robot) {
  const auto& kinematics = *robot.kinematics;
  const bool whole = kinematics.task() == arm_kinematics::Task::kPose;
  std::printf("%s: %d joints from %s to %s, camera %s, one command in %g s\n", robot.folder.c_str(),
              kinematics.joint_count(), robot.base_link.c_str(), robot.tip_link.c_str(),
              robot.camera_frame.c_str(), robot.driver_period);
  std::puts(
      whole ? "follows position and orientation of the tip"
            : "follows position and z axis of the tip: 5 joints cannot turn it about that axis");
  std::printf("%-28s%10s%10s%10s%10s\n", "joint", "lower", "upper", "speed", "ready");
  for (Eigen::Index i = 0; i < robot.ready.size(); ++i) {
    const auto& limits = kinematics.limits();
    std::printf("%-28s%10.4f%10.4f%10.4f%10.4f\n",
                robot.joints[static_cast<std::size_t>(i)].c_str(), limits.lower[i], limits.upper[i],
                limits.velocity[i], robot.ready[i]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: show_robot NAME|/path/to/folder\n", stderr);
    return 2;
  }
  try {
    print(prf_robots::load_robot(prf_robots::robot_folder(argv[1])));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "show_robot: %s\n", error.what());
    return 2;
  }
  return 0;
}
