// SPDX-License-Identifier: BSD-3-Clause
// Images of libapriltag's own tag36h11 bitmaps at known poses.
#pragma once

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "prf_perception/tag_detector.hpp"

namespace prf_perception {

inline cv::Mat tag_bitmap(int id, int module_px) {
  apriltag_family_t* family = tag36h11_create();
  image_u8_t* raw = apriltag_to_image(family, static_cast<std::uint32_t>(id));
  const cv::Mat modules(raw->height, raw->width, CV_8UC1, raw->buf,
                        static_cast<std::size_t>(raw->stride));
  cv::Mat bitmap;
  cv::resize(modules, bitmap, {}, module_px, module_px, cv::INTER_NEAREST);
  std::free(raw->buf);
  std::free(raw);
  tag36h11_destroy(family);
  return bitmap;
}

// Bitmap and image are indexed from pixel centres; a continuous coordinate is an index + 1/2.
inline void draw_tag(cv::Mat& image, const CameraIntrinsics& camera, double tag_size, int id,
                     const Eigen::Isometry3d& tag_in_camera) {
  constexpr int kModulePx = 32;
  constexpr int kSupersampling = 4;
  constexpr double kBitmapModules = 10;
  constexpr double kTagModules = 8;
  const cv::Mat bitmap = tag_bitmap(id, kModulePx);

  const double metres_per_px = tag_size / (kTagModules * kModulePx);
  const double middle = 0.5 * kBitmapModules * kModulePx - 0.5;
  Eigen::Matrix3d tag_from_bitmap;
  tag_from_bitmap << metres_per_px, 0, -middle * metres_per_px, 0, -metres_per_px,
      middle * metres_per_px, 0, 0, 1;
  Eigen::Matrix3d camera_from_tag;
  camera_from_tag << tag_in_camera.linear().leftCols<2>(), tag_in_camera.translation();
  Eigen::Matrix3d pixel_from_camera;
  pixel_from_camera << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  Eigen::Matrix3d fine_from_pixel;
  const double shift = 0.5 * kSupersampling - 0.5;
  fine_from_pixel << kSupersampling, 0, shift, 0, kSupersampling, shift, 0, 0, 1;
  const Eigen::Matrix3d homography =
      fine_from_pixel * pixel_from_camera * camera_from_tag * tag_from_bitmap;

  cv::Mat H(3, 3, CV_64F);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) H.at<double>(row, column) = homography(row, column);
  }
  cv::Mat fine;
  cv::resize(image, fine, {}, kSupersampling, kSupersampling, cv::INTER_NEAREST);
  cv::warpPerspective(bitmap, fine, H, fine.size(), cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
  cv::resize(fine, image, image.size(), 0, 0, cv::INTER_AREA);
}

inline void add_noise(cv::Mat& image, double sigma, cv::RNG& random) {
  cv::Mat noise(image.size(), CV_16SC1);
  random.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::add(image, noise, image, cv::noArray(), CV_8UC1);
}

inline ImageView view_of(const cv::Mat& image) {
  return {image.data, image.cols, image.rows, static_cast<int>(image.step)};
}

inline CameraIntrinsics test_camera() { return {615, 615, 319.5, 239.5, 640, 480}; }

// Seen head on: the tag's x is the camera's, y and z are opposite. Turned about the tag's own axes.
inline Eigen::Isometry3d tag_pose(const Eigen::Vector3d& position, double about_x = 0,
                                  double about_y = 0, double about_z = 0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  pose.linear() =
      (Eigen::Quaterniond(0, 1, 0, 0) * Eigen::AngleAxisd(about_z, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return pose;
}

}  // namespace prf_perception
