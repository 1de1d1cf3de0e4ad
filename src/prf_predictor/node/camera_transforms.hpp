// SPDX-License-Identifier: BSD-3-Clause
// The pose of the camera in the planning frame at the stamp of an image, as soon as it is final.
//
// A stamp is ready when every moving frame between camera and planning frame has a sample later
// than the stamp. The same two neighbours are then interpolated whatever order the messages of
// different topics came in. (tf2 copies a sample at exactly its stamp while it is the newest one
// and interpolates afterwards, which differs in the last bit.)
#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <prf_core/clock_monitor.hpp>
#include <string>

namespace prf_predictor {

class CameraTransforms {
 public:
  enum class Readiness {
    kReady,
    kWait,   // later tf may bring it
    kNever,  // no later tf can bring it, or tf is more than `max_wait` past the stamp
  };

  struct LookupResult {
    Readiness readiness = Readiness::kWait;
    Eigen::Isometry3d camera_in_planning = Eigen::Isometry3d::Identity();
    std::string reason;  // when not ready
  };

  // Frames whose names begin with `ignored_prefix` are not stored: the detector sends them.
  CameraTransforms(std::string planning_frame, std::string ignored_prefix,
                   prf_core::Duration max_wait);

  // A backward jump of tf's stamps begins a new run: earlier tf is dropped.
  void add(const tf2_msgs::TFMessage& message, bool is_static);

  // The images began a new run at this stamp: tf of the old run is dropped.
  void begin_run(prf_core::Stamp stamp);

  [[nodiscard]] LookupResult lookup(const std::string& camera_frame, prf_core::Stamp stamp) const;

 private:
  std::string planning_frame_;
  std::string ignored_prefix_;
  prf_core::Duration max_wait_;
  tf2::BufferCore buffer_;
  prf_core::ClockMonitor clock_;  // of the moving frames
  bool has_static_ = false;
};

}  // namespace prf_predictor
