// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <set>
#include <string>
#include <vector>

#include "camera_sim/camera_renderer.hpp"
#include "platform_sim/world.hpp"

namespace platform_sim {

// Everything that the simulated robot and the ground truth say.
class SimPublishers {
 public:
  // `with_joint_states`: false when a driver says them. Of what disturbs the world nothing is told,
  // nor the topic advertised, unless `is_disturbed`.
  SimPublishers(ros::NodeHandle& node, bool with_joint_states, bool is_disturbed);

  // Once: what stands in the hand's way, in the tag's frame. Nothing when nothing does.
  void publish_obstacles(const camera_sim::TargetBox& target);
  void publish_clock(std::int64_t now_ms);
  void publish_image(std::int64_t stamp_ms, const cv::Mat& image,
                     const camera_sim::PinholeCamera& camera);
  void publish_ground_truth(std::int64_t now_ms, World& world);
  // What acts on the world from outside, as the fault injector tells its faults.
  void publish_disturbances(std::int64_t now_ms, const World& world);
  void publish_joint_states(std::int64_t now_ms, const World& world);
  void publish_diagnostics(std::int64_t now_ms, double real_time_factor, double ticks_per_second,
                           unsigned refused, unsigned unanswered);

  [[nodiscard]] bool image_is_wanted() const { return image_.getNumSubscribers() > 0; }
  // Subscribers of all topics together.
  [[nodiscard]] unsigned subscribers() const;
  // Of the topics that somebody must hear, those that nobody does.
  [[nodiscard]] std::vector<std::string> without_subscriber(bool camera_too) const;

 private:
  ros::Publisher clock_, image_, camera_info_, joint_states_, obstacles_, diagnostics_;
  ros::Publisher platform_, base_, tag_, camera_, end_effector_, contacts_;
  ros::Publisher events_;       // none unless is_disturbed
  std::set<std::string> told_;  // disturbances that were described
};

}  // namespace platform_sim
