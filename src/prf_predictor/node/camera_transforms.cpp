// SPDX-License-Identifier: BSD-3-Clause
#include "camera_transforms.hpp"

#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>
#include <prf_ros/conversions.hpp>

#include <utility>

namespace prf_predictor {

using prf_core::Stamp;
using prf_core::StampOrder;
using prf_ros::to_core;

CameraTransforms::CameraTransforms(std::string planning_frame, std::string ignored_prefix,
                                   prf_core::Duration max_wait)
    : planning_frame_(std::move(planning_frame)),
      ignored_prefix_(std::move(ignored_prefix)),
      max_wait_(max_wait) {}

void CameraTransforms::add(const tf2_msgs::TFMessage& message, bool is_static) {
  for (const auto& transform : message.transforms) {
    if (transform.child_frame_id.rfind(ignored_prefix_, 0) == 0) continue;
    if (!is_static &&
        clock_.observe(to_core(transform.header.stamp)) == StampOrder::kBackwardJump) {
      buffer_.clear();
    }
    buffer_.setTransform(transform, "tf", is_static);
    has_static_ = has_static_ || is_static;
  }
}

void CameraTransforms::begin_run(Stamp stamp) {
  if (!clock_.jumps_back(stamp)) return;
  buffer_.clear();
  clock_.restart();
}

CameraTransforms::LookupResult CameraTransforms::lookup(const std::string& camera_frame,
                                                        Stamp stamp) const {
  LookupResult result;
  if (stamp == Stamp{0}) {
    result.readiness = Readiness::kNever;
    result.reason = "stamp 0 means the latest time to tf";
    return result;
  }
  const Stamp newest = clock_.newest().value_or(Stamp{0});
  bool is_decided = newest > stamp + max_wait_;
  try {
    const ros::Time latest =
        buffer_.lookupTransform(planning_frame_, camera_frame, ros::Time()).header.stamp;
    const bool nothing_moves = latest.isZero();
    is_decided = is_decided || nothing_moves || to_core(latest) > stamp;
  } catch (const tf2::TransformException& error) {
    result.reason = error.what();
    const bool tree_is_known = has_static_ && newest > stamp;
    is_decided = is_decided || tree_is_known;
  }
  if (!is_decided) return result;
  try {
    result.camera_in_planning = tf2::transformToEigen(
        buffer_.lookupTransform(planning_frame_, camera_frame, prf_ros::to_ros_time(stamp)));
    result.readiness = Readiness::kReady;
  } catch (const tf2::TransformException& error) {
    result.readiness = Readiness::kNever;
    result.reason = error.what();
  }
  return result;
}

}  // namespace prf_predictor
