// SPDX-License-Identifier: BSD-3-Clause
// What target_predictor_node tells about itself: counts of what it took and dropped, the state of
// the track and the frequencies that the predictor found, in /diagnostics and as warnings.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/wall_throttle.hpp>

#include <map>
#include <string>

#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {

class Health {
 public:
  Health();

  void count(const std::string& what) { ++counts_[what]; }
  // Counts and warns, throttled for each reason by itself: none hides another.
  void warn(const std::string& what, const std::string& detail);
  void drop(const std::string& reason, const std::string& detail = "");
  void report(const TrackerResult& result);
  void report_waiting(std::size_t images) { waiting_ = images; }

  // What is wrong with the inputs is part of the diagnostics from then on.
  void watch(const prf_ros::InputMonitor& inputs) { inputs_ = &inputs; }

  [[nodiscard]] diagnostic_updater::Updater& updater() { return updater_; }
  void publish() { updater_.update(); }
  void publish_now() { updater_.force_update(); }

 private:
  void fill(diagnostic_updater::DiagnosticStatusWrapper& status);

  std::map<std::string, std::size_t> counts_;
  prf_ros::WallThrottles told_;
  const prf_ros::InputMonitor* inputs_ = nullptr;
  std::size_t waiting_ = 0;
  TargetStatus status_ = TargetStatus::kNoTarget;
  std::optional<Belief> belief_;
  diagnostic_updater::Updater updater_;
};

}  // namespace prf_predictor
