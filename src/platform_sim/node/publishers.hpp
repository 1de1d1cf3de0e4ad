// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "camera_sim/camera_renderer.hpp"
#include "platform_sim/world.hpp"

namespace platform_sim {

// Everything that the simulated robot and the ground truth say.
class SimPublishers {
 public:
  // `with_joint_states`: false when a driver says them.
  SimPublishers(ros::NodeHandle& node, bool with_joint_states);

  void publish_clock(std::int64_t now_ms);
  void publish_image(std::int64_t stamp_ms, const cv::Mat& image,
                     const camera_sim::PinholeCamera& camera);
  void publish_ground_truth(std::int64_t now_ms, World& world);
  void publish_joint_states(std::int64_t now_ms, const World& world);
  void publish_diagnostics(std::int64_t now_ms, double real_time_factor, double ticks_per_second,
                           unsigned refused, unsigned unanswered);

  [[nodiscard]] bool image_is_wanted() const { return image_.getNumSubscribers() > 0; }
  // Subscribers of all topics together.
  [[nodiscard]] unsigned subscribers() const;
  // Of the topics that somebody must hear, those that nobody does.
  [[nodiscard]] std::vector<std::string> without_subscriber(bool camera_too) const;

 private:
  ros::Publisher clock_, image_, camera_info_, joint_states_, diagnostics_;
  ros::Publisher platform_, base_, tag_, camera_, end_effector_, contacts_;
};

}  // namespace platform_sim
