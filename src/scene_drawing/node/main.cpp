// SPDX-License-Identifier: BSD-3-Clause
// Shows a person what stands around the robot: markers in base_link for rviz, from the ground
// truth.
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <prf_msgs/ground_truth_topics.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <optional>
#include <prf_core/clock_monitor.hpp>
#include <prf_ros/conversions.hpp>
#include <prf_ros/private_parameters.hpp>
#include <prf_ros/wall_throttle.hpp>
#include <stdexcept>

#include "camera_sim/target_box.hpp"

namespace scene_drawing {
namespace {

namespace topics = prf_msgs::topics;
namespace truth = prf_msgs::ground_truth_topics;

constexpr int kEvery = 5;                // ticks: 20 Hz
constexpr std::size_t kMostTicks = 100;  // that wait for all their parts

class SceneMarkers {
 public:
  explicit SceneMarkers(ros::NodeHandle node)
      : publisher_(node.advertise<visualization_msgs::MarkerArray>(topics::kSceneMarkers, 10)) {
    subscribers_ = {
        node.subscribe(truth::kGroundTruthPlatform, 100, &SceneMarkers::on_odometry, this),
        node.subscribe(truth::kGroundTruthBase, 100, &SceneMarkers::on_odometry, this),
        node.subscribe(truth::kGroundTruthTag, 100, &SceneMarkers::on_tag, this)};
  }

 private:
  struct Tick {
    std::optional<Eigen::Isometry3d> platform, base, tag;
  };

  void on_odometry(const nav_msgs::OdometryConstPtr& message) {
    const bool is_base = message->child_frame_id == "base_link";
    if (!is_base) target_.on_cart = message->child_frame_id == "floor";
    take(message->header.stamp, message->pose.pose, is_base ? &Tick::base : &Tick::platform);
  }

  void on_tag(const geometry_msgs::PoseStampedConstPtr& message) {
    take(message->header.stamp, message->pose, &Tick::tag);
  }

  void take(const ros::Time& stamp, const geometry_msgs::Pose& message,
            std::optional<Eigen::Isometry3d> Tick::*part) {
    const prf_core::Pose pose = prf_ros::to_core(message);
    try {
      prf_core::require_pose("pose", pose);
    } catch (const std::invalid_argument& error) {
      if (refusals_.is_due()) ROS_WARN("a pose of the ground truth is dropped: %s", error.what());
      return;
    }
    ticks_[stamp].*part = pose.isometry();
    while (ticks_.size() > kMostTicks) ticks_.erase(ticks_.begin());
    show(stamp);
  }

  void show(const ros::Time& stamp) {
    const Tick tick = ticks_[stamp];
    if (!tick.platform || !tick.base || !tick.tag) return;
    ticks_.erase(stamp);
    const prf_core::StampOrder order = clock_.observe(prf_ros::to_core(stamp));
    if (!prf_core::is_accepted(order)) return;
    if (order == prf_core::StampOrder::kBackwardJump) {  // a new run
      known_ = false;
      ticks_.clear();
    }
    // What carries the box starts where the platform is.
    if (!known_) target_.place_tag(tick.platform->inverse() * *tick.tag);
    known_ = true;
    if (count_++ % kEvery != 0) return;
    const Eigen::Isometry3d to_base = tick.base->inverse();
    publisher_.publish(markers(stamp, to_base * *tick.platform,
                               to_base * *tick.tag * target_.tag_in_platform().inverse()));
  }

  [[nodiscard]] visualization_msgs::MarkerArray markers(const ros::Time& stamp,
                                                        const Eigen::Isometry3d& platform,
                                                        const Eigen::Isometry3d& carrier) const {
    visualization_msgs::MarkerArray array;
    const auto add = [&](const Eigen::Isometry3d& frame, const camera_sim::Cuboid& cuboid,
                         float red, float green, float blue) {
      visualization_msgs::Marker& marker = array.markers.emplace_back();
      marker.header.stamp = stamp;
      marker.header.frame_id = "base_link";
      marker.ns = "scene";
      marker.id = static_cast<int>(array.markers.size());
      marker.type = visualization_msgs::Marker::CUBE;
      marker.pose = prf_ros::to_message(prf_core::pose_from(frame * cuboid.pose_in_platform));
      marker.scale = prf_ros::to_vector3(cuboid.size);
      marker.color.r = red;
      marker.color.g = green;
      marker.color.b = blue;
      marker.color.a = 1.0F;
    };
    add(platform, camera_sim::deck(), 0.50F, 0.53F, 0.57F);
    for (const camera_sim::Cuboid& wall : target_.walls()) add(carrier, wall, 0.87F, 0.72F, 0.48F);
    for (const camera_sim::Cuboid& part : target_.support())
      add(carrier, part, 0.45F, 0.50F, 0.60F);
    for (const double size : {1.25, 1.0}) {  // paper and ink
      camera_sim::Cuboid tag;
      tag.pose_in_platform = target_.tag_in_platform();
      tag.size =
          Eigen::Vector3d(size * target_.tag_size, size * target_.tag_size, 3e-3 - 1e-3 * size);
      const float grey = size > 1.0 ? 0.95F : 0.1F;
      add(carrier, tag, grey, grey, grey);
    }
    return array;
  }

  camera_sim::TargetBox target_;
  std::map<ros::Time, Tick> ticks_;
  prf_core::ClockMonitor clock_;
  prf_ros::WallThrottle refusals_;
  bool known_ = false;
  std::size_t count_ = 0;
  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace
}  // namespace scene_drawing

int main(int argc, char** argv) {
  ros::init(argc, argv, "scene_markers");
  return prf_ros::run([] {
    const scene_drawing::SceneMarkers markers{ros::NodeHandle()};
    ros::spin();
  });
}
