// SPDX-License-Identifier: BSD-3-Clause
// Draws the scene of a recorded run at one instant.
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "platform_sim/scene_renderer.hpp"

namespace {

using platform_sim::SceneState;

constexpr char kUsage[] =
    "usage: scene_picture URDF BAG TIME OUT.png\n"
    "  draws robot, platform and target at TIME (simulated s) from the bag's joint_states and\n"
    "  ground_truth/{platform,base}\n";

const Eigen::Vector3d kEye(-1.95, -1.50, 1.65);  // m, in world: behind, to the right
const Eigen::Vector3d kFocus(0.33, 0.02, 0.63);

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::invalid_argument("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

double to_time(const std::string& text) {
  std::size_t used = 0;
  double time = std::nan("");
  try {
    time = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || !(time >= 0.0)) {
    throw std::invalid_argument("TIME = " + text + ", must be a number of seconds >= 0");
  }
  return time;
}

Eigen::Isometry3d to_eigen(const geometry_msgs::Pose& pose) {
  const geometry_msgs::Quaternion& q = pose.orientation;
  return Eigen::Translation3d(pose.position.x, pose.position.y, pose.position.z) *
         Eigen::Quaterniond(q.w, q.x, q.y, q.z);
}

// State at the last tick not after `time`.
SceneState state_at(const std::string& bag_path, double time) {
  rosbag::Bag bag(bag_path, rosbag::bagmode::Read);
  rosbag::View view(
      bag, rosbag::TopicQuery({"/joint_states", "/ground_truth/platform", "/ground_truth/base"}));
  constexpr double kHalfTick = 0.005;  // s
  SceneState state;
  int parts = 0;
  for (const rosbag::MessageInstance& instance : view) {
    if (const auto joints = instance.instantiate<sensor_msgs::JointState>()) {
      if (joints->header.stamp.toSec() > time + kHalfTick) continue;
      for (std::size_t i = 0; i < joints->name.size(); ++i) {
        state.joints[joints->name[i]] = joints->position.at(i);
      }
      parts |= 1;
    } else if (const auto odometry = instance.instantiate<nav_msgs::Odometry>()) {
      if (odometry->header.stamp.toSec() > time + kHalfTick) continue;
      const bool is_base = odometry->child_frame_id == "base_link";
      (is_base ? state.base : state.platform) = to_eigen(odometry->pose.pose);
      parts |= is_base ? 2 : 4;
    }
  }
  if (parts != 7) throw std::invalid_argument(bag_path + " has no full state up to this time");
  return state;
}

void draw(const std::string& urdf_path, const std::string& bag_path, const std::string& time,
          const std::string& out_path) {
  const platform_sim::SceneRenderer renderer(read_file(urdf_path), platform_sim::TargetBox{});
  const platform_sim::PinholeCamera camera{1280, 960, 1150.0, 1150.0, 639.5, 479.5};
  const cv::Mat image = renderer.render(state_at(bag_path, to_time(time)), camera,
                                        platform_sim::look_at(kEye, kFocus));
  if (!cv::imwrite(out_path, image)) throw std::invalid_argument("cannot write " + out_path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    draw(argv[1], argv[2], argv[3], argv[4]);
  } catch (const std::exception& error) {
    std::cerr << "scene_picture: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
