// SPDX-License-Identifier: BSD-3-Clause
// Messages to core types and back.
#pragma once

#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/TransformStamped.h>
#include <prf_msgs/TagDetectionArray.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/RegionOfInterest.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>
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

// The image in grey, 8 bits. Throws std::invalid_argument for numbers that do not fit each other,
// and for an encoding that is not in image_layout.hpp.
inline cv_bridge::CvImageConstPtr to_grey(const sensor_msgs::ImageConstPtr& image) {
  namespace encodings = sensor_msgs::image_encodings;
  ImageLayout{image->encoding, image->width, image->height, image->step, image->data.size()}
      .validate();
  const bool is_grey = image->encoding == encodings::TYPE_8UC1;  // which cv_bridge does not convert
  return cv_bridge::toCvShare(image, is_grey ? std::string() : encodings::MONO8);
}

// The part of the sensor that the image shows: sensor_msgs/CameraInfo's roi, the whole when it is
// zero. Whether a rectified window is wanted (do_rectify) is nothing to the raw image.
inline sensor_msgs::RegionOfInterest window_of(const sensor_msgs::CameraInfo& info) {
  using prf_core::require;
  sensor_msgs::RegionOfInterest window = info.roi;
  const auto text = [](std::uint64_t size, std::uint64_t offset) {
    return std::to_string(size) + " px from " + std::to_string(offset);
  };
  const bool is_whole =
      window.width == 0 && window.height == 0 && window.x_offset == 0 && window.y_offset == 0;
  if (is_whole) {
    window.width = info.width;
    window.height = info.height;
  }
  const auto fits = [&](const char* name, std::uint64_t size, std::uint64_t offset,
                        std::uint32_t whole) {
    require(size > 0 && offset + size <= whole, name, text(size, offset),
            "within camera_info's " + std::to_string(whole) + " px, which are the whole sensor's");
  };
  fits("roi width of camera_info", window.width, window.x_offset, info.width);
  fits("roi height of camera_info", window.height, window.y_offset, info.height);
  return window;
}

// Of the names in sensor_msgs/distortion_models.h. Zeros mean a pinhole for those of Brown's kind
// only; without a name they mean no distortion.
inline void read_lens(const sensor_msgs::CameraInfo& info, CameraIntrinsics& camera) {
  namespace models = sensor_msgs::distortion_models;
  using prf_core::require;
  const std::string& model = info.distortion_model;
  const auto is_zero = [](double d) { return d == 0.0; };
  if (model.empty() && std::all_of(info.D.begin(), info.D.end(), is_zero)) return;
  std::size_t count = 0;
  if (model == models::PLUMB_BOB) {
    count = 5;
  } else if (model == models::RATIONAL_POLYNOMIAL) {
    count = 8;
  } else if (model == models::EQUIDISTANT) {
    count = 4;
    camera.lens = LensModel::kEquidistant;
    require(info.D.size() >= count, "length of D of camera_info", info.D.size(),
            "4 for equidistant (is the camera calibrated?)");
  }
  require(count > 0, "distortion_model of camera_info", quoted(model),
          "plumb_bob, rational_polynomial or equidistant");
  const std::size_t given = std::min(count, info.D.size());
  require(std::all_of(info.D.begin() + static_cast<std::ptrdiff_t>(given), info.D.end(), is_zero),
          "length of D of camera_info", info.D.size(),
          "up to " + std::to_string(count) + " for " + model);
  std::copy_n(info.D.begin(), given, camera.distortion.begin());
}

// The camera as it took this image. K is of the whole sensor at full resolution; as in
// image_geometry the principal point is moved into the window, then everything is divided by the
// binning. R and P are of rectified images and are not used.
// Throws std::invalid_argument for what the detector cannot use: another frame than the image's,
// sizes that do not fit the image, sheared pixels, a lens of another model than lens.hpp has.
inline CameraIntrinsics to_intrinsics(const sensor_msgs::CameraInfo& info,
                                      const sensor_msgs::Image& image) {
  using prf_core::require;
  require(info.header.frame_id == image.header.frame_id, "frame_id of camera_info",
          quoted(info.header.frame_id), "the image's, " + quoted(image.header.frame_id));
  const sensor_msgs::RegionOfInterest window = window_of(info);
  const std::uint32_t binning_x = std::max(info.binning_x, 1U);
  const std::uint32_t binning_y = std::max(info.binning_y, 1U);
  const auto fits = [](const std::string& name, std::uint32_t size, std::uint32_t binning,
                       std::uint32_t wanted) {
    require(size / binning == wanted, name,
            std::to_string(size) + " px, binned by " + std::to_string(binning),
            std::to_string(wanted) + " px in the end, the image's");
  };
  fits("width of camera_info", window.width, binning_x, image.width);
  fits("height of camera_info", window.height, binning_y, image.height);
  const auto& K = info.K;
  require(K[1] == 0.0 && K[3] == 0.0 && K[6] == 0.0 && K[7] == 0.0 && K[8] == 1.0,
          "K of camera_info", K[0], "fx 0 cx 0 fy cy 0 0 1 (is the camera calibrated?)");
  CameraIntrinsics camera{K[0] / binning_x,
                          K[4] / binning_y,
                          (K[2] - window.x_offset) / binning_x,
                          (K[5] - window.y_offset) / binning_y,
                          static_cast<int>(image.width),
                          static_cast<int>(image.height)};
  read_lens(info, camera);
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
