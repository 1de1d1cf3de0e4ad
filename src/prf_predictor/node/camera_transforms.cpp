// SPDX-License-Identifier: BSD-3-Clause
#include "camera_transforms.hpp"

#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>

#include <utility>

namespace prf_predictor {
namespace {

const ros::Duration kNewRun(1.0);
constexpr char kAuthority[] = "tf";

// Frames of the markers themselves come from the detector, they are no input here.
bool is_marker(const std::string& frame) { return frame.rfind("tag_", 0) == 0; }

}  // namespace

CameraTransforms::CameraTransforms(std::string planning_frame, ros::Duration patience)
    : planning_frame_(std::move(planning_frame)), patience_(patience) {}

void CameraTransforms::add(const tf2_msgs::TFMessage& message, bool is_static) {
  for (const auto& transform : message.transforms) {
    if (is_marker(transform.child_frame_id)) continue;
    if (!is_static) {
      if (transform.header.stamp + kNewRun < newest_) forget();
      newest_ = std::max(newest_, transform.header.stamp);
    }
    buffer_.setTransform(transform, kAuthority, is_static);
    has_static_ = has_static_ || is_static;
  }
}

void CameraTransforms::begin_run(const ros::Time& stamp) {
  if (stamp + kNewRun < newest_) forget();
}

void CameraTransforms::forget() {
  buffer_.clear();
  newest_ = ros::Time();
}

CameraTransforms::Lookup CameraTransforms::lookup(const std::string& camera_frame,
                                                  const ros::Time& stamp) const {
  Lookup result;
  if (stamp.isZero()) {
    result.readiness = Readiness::kNever;
    result.reason = "stamp 0 means the latest time to tf";
    return result;
  }
  bool is_decided = newest_ > stamp + patience_;
  try {
    const ros::Time latest =
        buffer_.lookupTransform(planning_frame_, camera_frame, ros::Time()).header.stamp;
    const bool nothing_moves = latest.isZero();
    is_decided = is_decided || nothing_moves || latest > stamp;
  } catch (const tf2::TransformException& error) {
    result.reason = error.what();
    const bool tree_is_known = has_static_ && newest_ > stamp;
    is_decided = is_decided || tree_is_known;
  }
  if (!is_decided) return result;
  try {
    result.camera_in_planning =
        tf2::transformToEigen(buffer_.lookupTransform(planning_frame_, camera_frame, stamp));
    result.readiness = Readiness::kReady;
  } catch (const tf2::TransformException& error) {
    result.readiness = Readiness::kNever;
    result.reason = error.what();
  }
  return result;
}

}  // namespace prf_predictor
