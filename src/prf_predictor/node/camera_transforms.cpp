// SPDX-License-Identifier: BSD-3-Clause
#include "camera_transforms.hpp"

#include <prf_core/quoted.hpp>
#include <prf_ros/conversions.hpp>

#include <utility>

namespace prf_predictor {
namespace {

using Effect = FrameChain::Effect;

// As tf2 does: frames had a leading slash once.
std::string frame_name(const std::string& name) {
  return name.rfind('/', 0) == 0 ? name.substr(1) : name;
}

const char* reason(Effect effect) {
  switch (effect) {
    case Effect::kOld:
      return "tf with an old stamp";
    case Effect::kDuplicate:
      return "tf with a stamp that came before";
    case Effect::kFarAhead:
      return "tf with a stamp far in the future";
    case Effect::kOtherParent:
      return "tf with another parent";
    case Effect::kBadPose:
      return "tf that is no finite pose";
    default:
      return nullptr;
  }
}

}  // namespace

CameraTransforms::CameraTransforms(const std::string& planning_frame, std::string ignored_prefix,
                                   prf_core::Duration max_wait, Health& health)
    : chain_(frame_name(planning_frame), max_wait),
      ignored_prefix_(std::move(ignored_prefix)),
      health_(health) {}

void CameraTransforms::add(const tf2_msgs::TFMessage& message, const std::string& publisher,
                           bool is_static) {
  for (const auto& transform : message.transforms) {
    const std::string child = frame_name(transform.child_frame_id);
    if (child.rfind(ignored_prefix_, 0) == 0) continue;
    const auto stamp = prf_ros::usable_stamp(transform.header.stamp);
    if (!stamp) {
      health_.drop("tf with a stamp near the end of ROS time", "of " + prf_core::quoted(child));
      continue;
    }
    const auto& [translation, rotation] =
        std::tie(transform.transform.translation, transform.transform.rotation);
    const FrameChain::Transform sample{frame_name(transform.header.frame_id),
                                       child,
                                       *stamp,
                                       {prf_ros::to_core(translation), prf_ros::to_core(rotation)}};
    report(sample, chain_.add(sample, is_static), publisher);
  }
}

void CameraTransforms::report(const FrameChain::Transform& transform, Effect effect,
                              const std::string& publisher) {
  if (effect == Effect::kTooMany) health_.drop("tf of more than 1000 frames");
  if (!chain_.has(transform.child)) return;  // so that foreign names do not fill the memory
  std::string& before = publishers_[transform.child];
  const bool is_other = !before.empty() && before != publisher;
  if ((is_other || reason(effect) != nullptr) &&
      chain_.is_between(transform.child, camera_frame_)) {
    const std::string what =
        "of " + prf_core::quoted(transform.child) + " from " + prf_core::quoted(publisher);
    if (is_other)
      health_.warn("a second publisher of tf", what + " and from " + prf_core::quoted(before));
    if (reason(effect) != nullptr) health_.drop(reason(effect), what);
  }
  before = publisher;
}

FrameChain::LookupResult CameraTransforms::lookup(const std::string& camera_frame,
                                                  prf_core::Stamp stamp) {
  const std::string name = frame_name(camera_frame);
  const auto result = chain_.lookup(name, stamp);
  if (result.readiness == FrameChain::Readiness::kReady) camera_frame_ = name;
  return result;
}

}  // namespace prf_predictor
