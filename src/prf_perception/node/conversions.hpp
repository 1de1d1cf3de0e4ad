// SPDX-License-Identifier: BSD-3-Clause
// Messages to core types and back.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <prf_msgs/TagDetectionArray.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/distortion_models.h>
#include <std_msgs/Header.h>

#include <algorithm>
#include <prf_ros/conversions.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "prf_perception/tag_detector.hpp"

namespace prf_perception {

// Throws std::invalid_argument for a lens of another model than plumb_bob.
inline CameraIntrinsics to_intrinsics(const sensor_msgs::CameraInfo& info) {
  CameraIntrinsics camera{info.K[0],
                          info.K[4],
                          info.K[2],
                          info.K[5],
                          static_cast<int>(info.width),
                          static_cast<int>(info.height),
                          {}};
  if (std::all_of(info.D.begin(), info.D.end(), [](double d) { return d == 0.0; })) return camera;
  if (info.distortion_model != sensor_msgs::distortion_models::PLUMB_BOB ||
      info.D.size() > camera.distortion.size()) {
    throw std::invalid_argument("camera_info has distortion_model = '" + info.distortion_model +
                                "' with " + std::to_string(info.D.size()) +
                                " coefficients, must be plumb_bob with up to 5, or none");
  }
  std::copy(info.D.begin(), info.D.end(), camera.distortion.begin());
  return camera;
}

inline prf_msgs::TagDetectionArray to_message(const std_msgs::Header& header,
                                              const std::string& family,
                                              const std::vector<TagDetection>& detections) {
  prf_msgs::TagDetectionArray array;
  array.header = header;
  for (const TagDetection& detection : detections) {
    prf_msgs::TagDetection message;
    message.family = family;
    message.id = detection.id;
    message.hamming = static_cast<std::uint8_t>(detection.hamming);
    message.decision_margin = static_cast<float>(detection.decision_margin);
    for (std::size_t i = 0; i < 4; ++i) {
      message.corners_px[2 * i] = detection.corners[i].x();
      message.corners_px[2 * i + 1] = detection.corners[i].y();
    }
    const Eigen::Isometry3d& pose = detection.pose.marker_in_camera;
    message.pose.pose.position = prf_ros::to_point(pose.translation());
    message.pose.pose.orientation = prf_ros::to_message(Eigen::Quaterniond(pose.linear()));
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.pose.covariance.data()) =
        detection.pose.covariance;
    array.detections.push_back(message);
  }
  return array;
}

inline geometry_msgs::TransformStamped to_transform(const std_msgs::Header& header,
                                                    const prf_msgs::TagDetection& detection) {
  geometry_msgs::TransformStamped transform;
  transform.header = header;
  transform.child_frame_id = "tag_" + std::to_string(detection.id);
  transform.transform.translation =
      prf_ros::to_vector3(prf_ros::to_core(detection.pose.pose.position));
  transform.transform.rotation = detection.pose.pose.orientation;
  return transform;
}

}  // namespace prf_perception
