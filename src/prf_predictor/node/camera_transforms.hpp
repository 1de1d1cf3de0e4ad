// SPDX-License-Identifier: BSD-3-Clause
// Where the camera was when an image was taken, as soon as that is certain.
//
// Fed with /tf and /tf_static from the node's own queue. An answer depends on the order within
// each topic alone: a stamp is ready once every moving frame between camera and planning frame has
// a sample AFTER it, so that the same two neighbours are interpolated whatever came when. (At a
// sample's own stamp tf2 copies the sample while it is the newest and interpolates afterwards,
// which differs in the last bit.)
#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <string>

namespace prf_predictor {

class CameraTransforms {
 public:
  enum class Readiness {
    kReady,
    kWait,   // more tf may still bring it
    kNever,  // no tf to come can bring it, or tf is more than `patience` past the stamp
  };

  struct Lookup {
    Readiness readiness = Readiness::kWait;
    Eigen::Isometry3d camera_in_planning = Eigen::Isometry3d::Identity();
    std::string reason;  // when not ready
  };

  CameraTransforms(std::string planning_frame, ros::Duration patience);

  // tf whose stamps go back by more than a second starts a new run: the old tf is forgotten.
  void add(const tf2_msgs::TFMessage& message, bool is_static);

  // The images started a new run at this stamp: tf of an old run is forgotten.
  void begin_run(const ros::Time& stamp);

  [[nodiscard]] Lookup lookup(const std::string& camera_frame, const ros::Time& stamp) const;

 private:
  void forget();

  std::string planning_frame_;
  ros::Duration patience_;
  tf2::BufferCore buffer_;
  ros::Time newest_;  // of the moving frames
  bool has_static_ = false;
};

}  // namespace prf_predictor
