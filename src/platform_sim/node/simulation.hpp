// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/time.h>
#include <std_srvs/Trigger.h>

#include <deque>
#include <future>
#include <optional>
#include <prf_ros/wall_throttle.hpp>
#include <string>

#include "camera_sim/camera_schedule.hpp"
#include "camera_sim/hand_camera.hpp"
#include "driver_interface.hpp"
#include "params.hpp"
#include "platform_sim/world.hpp"
#include "publishers.hpp"
#include "responses.hpp"

namespace platform_sim {

// Advances the world tick by tick, in lockstep with whoever moves the arm.
class Simulation {
 public:
  enum class End { kEnded, kInterrupted, kSilent };

  Simulation(ros::NodeHandle& node, ros::NodeHandle& private_node, const SimParams& params,
             const std::string& urdf);

  End run();

 private:
  struct Picture {
    cv::Mat pixels;
    ros::WallDuration took;
  };
  // Drawn in a thread of its own while physics and framework go on.
  struct Image {
    camera_sim::Frame frame;
    std::future<Picture> picture;  // not valid while nobody wants it
  };

  bool on_start(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  End wait_for_start();
  End wait_for_connections();
  End wait_for_responses();
  void simulate_tick();
  void publish_tick();
  void publish_due_images();
  void begin_to_draw(Image& image);
  void go_on(double patience);
  void apply_responses();
  void apply_driver();
  void heard_driver();
  void keep_pace();
  [[nodiscard]] bool at_end();
  void report_rate();
  void report_end() const;

  SimParams params_;
  std::int64_t tick_ms_;  // control period; the first tick is one period after the start
  World world_;
  camera_sim::HandCamera camera_;
  camera_sim::CameraSchedule schedule_;
  std::deque<Image> images_;  // exposed, latency not yet over
  SimPublishers publishers_;
  Responses responses_;
  std::optional<DriverInterface> driver_;
  ros::ServiceServer start_service_;
  bool started_;
  std::int64_t now_ms_ = 0;
  std::optional<std::int64_t> end_ms_;
  bool finished_ = false;
  bool fallen_ = false;
  ros::WallTime begin_, last_report_;
  ros::WallTime pace_;  // wall time that time 0 would have at the capped rate
  std::int64_t last_report_ms_ = 0;
  unsigned unanswered_ = 0;  // ticks
  prf_ros::WallThrottle going_on_;
  ros::WallDuration physics_, rendering_, waiting_;
};

}  // namespace platform_sim
