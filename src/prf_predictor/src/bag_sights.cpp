// SPDX-License-Identifier: BSD-3-Clause
#include "bag_sights.hpp"

#include <prf_msgs/TagDetectionArray.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <deque>
#include <stdexcept>

#include "camera_transforms.hpp"
#include "conversions.hpp"

namespace prf_predictor {
namespace {

constexpr std::size_t kFewest = 30;
constexpr MeasurementDefaults kDefaults{0.002, 0.02};
const ros::Duration kPatience(0.5);

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

std::vector<Sight> sights_in_bag(const std::string& path, const std::string& planning_frame,
                                 int tag_id) {
  std::vector<Sight> sights;
  try {
    rosbag::Bag bag(path);
    CameraTransforms transforms(planning_frame, kPatience);
    std::deque<prf_msgs::TagDetectionArrayConstPtr> waiting;
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
      if (const auto tf = message.instantiate<tf2_msgs::TFMessage>()) {
        transforms.add(*tf, ends_with(message.getTopic(), "tf_static"));
      } else if (const auto array = message.instantiate<prf_msgs::TagDetectionArray>()) {
        if (!array->detections.empty()) waiting.push_back(array);
      }
      while (!waiting.empty()) {
        const auto& array = *waiting.front();
        const auto found = transforms.lookup(array.header.frame_id, array.header.stamp);
        if (found.readiness == CameraTransforms::Readiness::kWait) break;
        const double time = array.header.stamp.toSec();
        const bool is_new = sights.empty() || time > sights.back().time;
        for (const auto& detection : array.detections) {
          if (found.readiness != CameraTransforms::Readiness::kReady || !is_new) break;
          const auto checked = to_measurement(detection, kDefaults);
          if (detection.id != tag_id || !checked.measurement) continue;
          sights.push_back({time, found.camera_in_planning * *checked.measurement});
          break;
        }
        waiting.pop_front();
      }
    }
  } catch (const rosbag::BagException& error) {
    throw std::invalid_argument(path + " cannot be read: " + error.what());
  }
  if (sights.size() < kFewest) {
    throw std::invalid_argument(path + " has " + std::to_string(sights.size()) + " sights of tag " +
                                std::to_string(tag_id) + " in " + planning_frame +
                                ", must have at least 30");
  }
  return sights;
}

}  // namespace prf_predictor
