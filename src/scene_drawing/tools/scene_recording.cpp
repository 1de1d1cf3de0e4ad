// SPDX-License-Identifier: BSD-3-Clause
#include "scene_recording.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <prf_msgs/topics.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <prf_ros/bag.hpp>
#include <prf_ros/conversions.hpp>
#include <sstream>
#include <stdexcept>

namespace scene_drawing {
namespace {

const Eigen::Vector3d kEye(-1.95, -1.50, 1.65);  // m, in world
const Eigen::Vector3d kFocus(0.33, 0.02, 0.63);
constexpr double kFocalLength = 0.9;  // per width of the picture

// Bits of the messages that make a state.
enum Part : int { kJoints = 1, kPlatform = 2, kBase = 4, kTag = 8, kAll = 15 };

struct Tick {
  SceneState state;
  Eigen::Isometry3d tag = Eigen::Isometry3d::Identity();
  int parts = 0;
};

std::int64_t to_ns(const ros::Time& stamp) { return static_cast<std::int64_t>(stamp.toNSec()); }

class Reader {
 public:
  void read(const rosbag::MessageInstance& instance) {
    if (const auto joints = prf_ros::message_in<sensor_msgs::JointState>(instance)) {
      Tick& tick = ticks_[to_ns(joints->header.stamp)];
      for (std::size_t i = 0; i < std::min(joints->name.size(), joints->position.size()); ++i) {
        tick.state.joints[joints->name[i]] = joints->position[i];
      }
      tick.parts |= kJoints;
    } else if (const auto odometry = prf_ros::message_in<nav_msgs::Odometry>(instance)) {
      Tick& tick = ticks_[to_ns(odometry->header.stamp)];
      const bool is_base = odometry->child_frame_id == "base_link";
      (is_base ? tick.state.base : tick.state.platform) =
          prf_ros::to_core(odometry->pose.pose).isometry();
      tick.parts |= is_base ? kBase : kPlatform;
      on_cart_ = on_cart_ || odometry->child_frame_id == "floor";
    } else if (const auto tag = prf_ros::message_in<geometry_msgs::PoseStamped>(instance)) {
      Tick& tick = ticks_[to_ns(tag->header.stamp)];
      tick.tag = prf_ros::to_core(tag->pose).isometry();
      tick.parts |= kTag;
    } else if (const auto obstacles =
                   prf_ros::message_in<visualization_msgs::MarkerArray>(instance)) {
      obstructed_ = obstructed_ || !obstacles->markers.empty();
    }
  }

  // What carries the box starts where the platform is; from then on the tag tells its pose.
  [[nodiscard]] SceneRecording finish(const std::string& bag_path) {
    SceneRecording recording;
    recording.target.on_cart = on_cart_;
    recording.target.obstructed = obstructed_;
    for (auto& [stamp, tick] : ticks_) {
      if (tick.parts != kAll) continue;
      if (recording.states.empty()) {
        recording.target.place_tag(tick.state.platform.inverse() * tick.tag);
      }
      tick.state.carrier = tick.tag * recording.target.tag_in_platform().inverse();
      recording.states[stamp] = tick.state;
    }
    if (recording.states.empty()) {
      throw std::invalid_argument(
          bag_path + " has no tick with joint_states and ground_truth/{platform,base,tag}");
    }
    return recording;
  }

 private:
  std::map<std::int64_t, Tick> ticks_;
  bool on_cart_ = false;
  bool obstructed_ = false;
};

}  // namespace

const SceneState& SceneRecording::at(double time) const {
  constexpr double kHalfTick = 0.005;  // s
  const auto after = states.upper_bound(std::llround(1e9 * (time + kHalfTick)));
  if (after == states.begin()) {
    throw std::invalid_argument(
        "time " + std::to_string(time) + " s is before the first tick, must be at least " +
        std::to_string(1e-9 * static_cast<double>(states.begin()->first)) + " s");
  }
  return std::prev(after)->second;
}

SceneRecording read_scene(const std::string& bag_path) {
  rosbag::Bag bag;
  prf_ros::open_bag(bag, bag_path);
  rosbag::View view(bag, rosbag::TopicQuery({"/joint_states", "/ground_truth/platform",
                                             "/ground_truth/base", "/ground_truth/tag",
                                             std::string("/") + prf_msgs::topics::kObstacles}));
  Reader reader;
  try {
    for (const rosbag::MessageInstance& instance : view) reader.read(instance);
  } catch (const std::exception& error) {
    throw std::invalid_argument(bag_path + ": " + error.what());
  }
  return reader.finish(bag_path);
}

SceneRenderer make_renderer(const std::string& urdf_path, const camera_sim::TargetBox& target) {
  std::ifstream file(urdf_path);
  if (!file)
    throw std::invalid_argument(urdf_path + ": cannot be read, must be the URDF of the robot");
  std::ostringstream urdf;
  urdf << file.rdbuf();
  return {urdf.str(), target};
}

cv::Mat draw_overview(const SceneRenderer& renderer, const SceneState& state, int width) {
  camera_sim::PinholeCamera camera;
  camera.width = width;
  camera.height = width * 3 / 4;
  camera.fx = camera.fy = kFocalLength * width;
  camera.cx = 0.5 * camera.width - 0.5;
  camera.cy = 0.5 * camera.height - 0.5;
  return renderer.render(state, camera, look_at(kEye, kFocus));
}

double to_number(const std::string& name, const std::string& text, double low, double high) {
  std::size_t used = 0;
  double value = std::nan("");
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == text.size() && value >= low && value <= high) return value;
  std::ostringstream message;
  message << name << " = " << text << ", must be a number in " << low << ".." << high;
  throw std::invalid_argument(message.str());
}

}  // namespace scene_drawing
