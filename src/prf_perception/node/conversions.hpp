// SPDX-License-Identifier: BSD-3-Clause
// Messages to core types and back.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <prf_msgs/TagDetectionArray.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/distortion_models.h>
#include <std_msgs/Header.h>

#include <algorithm>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <prf_ros/conversions.hpp>
#include <string>
#include <vector>

#include "prf_perception/image_layout.hpp"
#include "prf_perception/tag_detector.hpp"

namespace prf_perception {

using prf_core::quoted;

inline ImageLayout to_layout(const sensor_msgs::Image& image) {
  return {image.encoding, image.width, image.height, image.step, image.data.size()};
}

// Throws std::invalid_argument for what the detector cannot use: another size than the image's or
// another frame, a lens of another model than plumb_bob, sheared or rectified pixels, a binned or
// cut image. R and P are of rectified images and are not used.
inline CameraIntrinsics to_intrinsics(const sensor_msgs::CameraInfo& info,
                                      const sensor_msgs::Image& image) {
  using prf_core::require;
  require(info.header.frame_id == image.header.frame_id, "frame_id of camera_info",
          quoted(info.header.frame_id), "the image's, " + quoted(image.header.frame_id));
  require(info.width == image.width, "width of camera_info", info.width,
          std::to_string(image.width) + " px, the image's");
  require(info.height == image.height, "height of camera_info", info.height,
          std::to_string(image.height) + " px, the image's");
  require(info.binning_x <= 1 && info.binning_y <= 1, "binning of camera_info",
          std::max(info.binning_x, info.binning_y), "0 or 1");
  const auto& roi = info.roi;
  const bool is_whole = roi.x_offset == 0 && roi.y_offset == 0 && !roi.do_rectify &&
                        (roi.width == 0 || roi.width == info.width) &&
                        (roi.height == 0 || roi.height == info.height);
  require(is_whole, "roi of camera_info",
          std::to_string(roi.width) + " x " + std::to_string(roi.height),
          "the whole image, not rectified");
  const auto& K = info.K;
  require(K[1] == 0.0 && K[3] == 0.0 && K[6] == 0.0 && K[7] == 0.0 && K[8] == 1.0,
          "K of camera_info", K[0], "fx 0 cx 0 fy cy 0 0 1 (is the camera calibrated?)");
  CameraIntrinsics camera{
      K[0], K[4], K[2], K[5], static_cast<int>(info.width), static_cast<int>(info.height), {}};
  if (std::all_of(info.D.begin(), info.D.end(), [](double d) { return d == 0.0; })) return camera;
  require(info.distortion_model == sensor_msgs::distortion_models::PLUMB_BOB,
          "distortion_model of camera_info", quoted(info.distortion_model), "plumb_bob, or D zero");
  require(info.D.size() <= camera.distortion.size(), "length of D of camera_info", info.D.size(),
          "up to 5");
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
    message.ambiguity = detection.pose.ambiguity();
    if (const auto& other = detection.pose.other_in_camera) {
      message.alternative_pose = prf_ros::to_message(
          prf_core::Pose{other->translation(), Eigen::Quaterniond(other->linear())});
    }
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
