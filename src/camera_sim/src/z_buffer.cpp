// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/z_buffer.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace camera_sim {
namespace {

constexpr double kNearPlane = 0.02;  // m

cv::Vec3b to_bgr(const Colour& colour) {
  const auto level = [](double value) {
    return static_cast<unsigned char>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
  };
  return {level(colour[2]), level(colour[1]), level(colour[0])};
}

// Of the pixels first .. last of row y those within a triangle, and a pixel more on each side.
std::pair<int, int> columns_inside(const Eigen::Matrix3d& to_barycentric, int y, int first,
                                   int last) {
  double low = first, high = last;
  for (int i = 0; i < 3; ++i) {
    const double slope = to_barycentric(i, 0);
    const double offset = to_barycentric(i, 1) * y + to_barycentric(i, 2);
    if (slope > 0.0) low = std::max(low, -offset / slope - 1.0);
    if (slope < 0.0) high = std::min(high, -offset / slope + 1.0);
  }
  if (!(low <= high)) return {0, -1};
  return {static_cast<int>(std::ceil(low)), static_cast<int>(std::floor(high))};
}

}  // namespace

ZBuffer::ZBuffer(const PinholeCamera& camera, const Colour& background) : camera_(camera) {
  camera.validate();
  camera_.width *= kOversampling;
  camera_.height *= kOversampling;
  camera_.fx *= kOversampling;
  camera_.fy *= kOversampling;
  camera_.cx = kOversampling * (camera.cx + 0.5) - 0.5;
  camera_.cy = kOversampling * (camera.cy + 0.5) - 0.5;
  inverse_depth_ = cv::Mat(camera_.height, camera_.width, CV_32FC1, cv::Scalar(0.0));
  // Row by row: OpenCV fills a picture of three channels pixel by pixel, a fifth of the drawing
  // time.
  const cv::Mat row(1, camera_.width, CV_8UC3, cv::Scalar(to_bgr(background)));
  image_.create(camera_.height, camera_.width, CV_8UC3);
  for (int y = 0; y < camera_.height; ++y) row.copyTo(image_.row(y));
}

void ZBuffer::draw(const Triangle& triangle, const Colour& colour) {
  const Eigen::Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  if (normal.dot(triangle[0]) >= 0.0) return;

  // 1/z is an affine function of the pixel: at the corners it is known.
  Eigen::Matrix3d corners;
  Eigen::Vector3d inverse_depths;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d& point = triangle[static_cast<std::size_t>(i)];
    if (point.z() < kNearPlane) return;
    corners.row(i) << camera_.to_pixel(point.hnormalized()).transpose(), 1.0;
    inverse_depths[i] = 1.0 / point.z();
  }
  const double twice_area = corners.determinant();
  if (std::abs(twice_area) < 1e-9) return;
  const Eigen::Matrix3d to_barycentric = corners.transpose().inverse();

  const auto first = [](double low) { return static_cast<int>(std::ceil(std::max(low, 0.0))); };
  const auto last = [](double high, int size) {
    return static_cast<int>(std::floor(std::min(high, size - 1.0)));
  };
  const int y_last = last(corners.col(1).maxCoeff(), camera_.height);
  const int x_first = first(corners.col(0).minCoeff());
  const int x_last = last(corners.col(0).maxCoeff(), camera_.width);
  const cv::Vec3b bgr = to_bgr(colour);
  for (int y = first(corners.col(1).minCoeff()); y <= y_last; ++y) {
    const auto [row_first, row_last] = columns_inside(to_barycentric, y, x_first, x_last);
    for (int x = row_first; x <= row_last; ++x) {
      const Eigen::Vector3d weights = to_barycentric * Eigen::Vector3d(x, y, 1.0);
      if (weights.minCoeff() < 0.0) continue;
      const float inverse_depth = static_cast<float>(weights.dot(inverse_depths));
      if (inverse_depth <= inverse_depth_.at<float>(y, x)) continue;
      inverse_depth_.at<float>(y, x) = inverse_depth;
      image_.at<cv::Vec3b>(y, x) = bgr;
    }
  }
}

cv::Mat ZBuffer::finish() const {
  cv::Mat image;
  cv::resize(image_, image, cv::Size(), 1.0 / kOversampling, 1.0 / kOversampling, cv::INTER_AREA);
  return image;
}

}  // namespace camera_sim
