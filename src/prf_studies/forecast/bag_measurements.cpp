// SPDX-License-Identifier: BSD-3-Clause
#include "bag_measurements.hpp"

#include <prf_msgs/TagDetectionArray.h>
#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>
#include <prf_ros/bag.hpp>
#include <prf_ros/conversions.hpp>

#include <optional>
#include <stdexcept>

namespace prf_studies {
namespace {

using prf_predictor::MeasurementDefaults;
using prf_predictor::TagMeasurement;

constexpr std::size_t kFewest = 30;
constexpr MeasurementDefaults kDefaults{0.002, 0.02};
const ros::Duration kWholeBag(1e8);  // how long tf is kept

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::optional<TagMeasurement> measurement_of(const prf_msgs::TagDetectionArray& array, int tag_id) {
  using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  for (const auto& detection : array.detections) {
    if (detection.id != tag_id) continue;
    const auto& pose = detection.pose.pose;
    const auto checked =
        check(prf_ros::to_core(pose.position), prf_ros::to_core(pose.orientation),
              Eigen::Map<const RowMajor6d>(detection.pose.covariance.data()), kDefaults);
    if (checked.measurement) return checked.measurement;
  }
  return std::nullopt;
}

}  // namespace

std::vector<TimedMeasurement> measurements_in_bag(const std::string& path,
                                                  const std::string& planning_frame, int tag_id) {
  std::vector<TimedMeasurement> measurements;
  rosbag::Bag bag;
  prf_ros::open_bag(bag, path);
  try {
    tf2::BufferCore transforms(kWholeBag);
    std::vector<prf_msgs::TagDetectionArrayConstPtr> images;
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
      if (const auto tf = prf_ros::message_in<tf2_msgs::TFMessage>(message)) {
        const bool is_static = ends_with(message.getTopic(), "tf_static");
        for (const auto& transform : tf->transforms) {
          transforms.setTransform(transform, "bag", is_static);
        }
      } else if (const auto array = prf_ros::message_in<prf_msgs::TagDetectionArray>(message)) {
        images.push_back(array);
      }
    }
    for (const auto& image : images) {
      const double time = image->header.stamp.toSec();
      if (!measurements.empty() && time <= measurements.back().time) continue;
      const auto measurement = measurement_of(*image, tag_id);
      if (!measurement) continue;
      try {
        measurements.push_back(
            {time, tf2::transformToEigen(transforms.lookupTransform(
                       planning_frame, image->header.frame_id, image->header.stamp)) *
                       *measurement});
      } catch (const tf2::TransformException&) {
        continue;  // before the first or after the last tf
      }
    }
  } catch (const std::exception& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
  if (measurements.size() < kFewest) {
    throw std::invalid_argument(path + " has " + std::to_string(measurements.size()) +
                                " measurements of tag " + std::to_string(tag_id) + " in " +
                                planning_frame + ", must have at least 30");
  }
  return measurements;
}

}  // namespace prf_studies
