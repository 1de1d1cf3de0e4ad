// SPDX-License-Identifier: BSD-3-Clause
// Says what a robot's folder holds, or in one line what is wrong with it (exit code 2). With --urdf
// or --KEY it prints the URDF or that text of robot.yaml alone, for launch files.
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
  const std::string option = argc == 3 ? argv[1] : "";
  const bool known = option == "--urdf" || option == "--base_link" || option == "--tip_link";
  if (argc != (known ? 3 : 2)) {
    std::fputs("usage: show_robot [--urdf|--base_link|--tip_link] NAME|/path/to/folder\n", stderr);
    return 2;
  }
  try {
    const auto robot = prf_robots::load_robot(prf_robots::robot_folder(argv[argc - 1]));
    if (!known) {
      print(robot);
      return 0;
    }
    const std::string& text = option == "--urdf"        ? robot.urdf
                              : option == "--base_link" ? robot.base_link
                                                        : robot.tip_link;
    std::fwrite(text.data(), 1, text.size(), stdout);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "show_robot: %s\n", error.what());
    return 2;
  }
  return 0;
}
