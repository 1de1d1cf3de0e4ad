// SPDX-License-Identifier: BSD-3-Clause
// Plane things as a camera with a distorting lens sees them, painted one over the other.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "camera_sim/pinhole_camera.hpp"
#include "polygon_raster.hpp"
#include "scene_facets.hpp"

namespace camera_sim {

// Where each pixel looks, worked out once.
class CameraLens {
 public:
  // `camera` is valid.
  explicit CameraLens(const PinholeCamera& camera);

  // The line of sight of a pixel's centre in normalised coordinates and its derivative.
  struct Ray {
    Eigen::Vector2d normalised;
    Eigen::Matrix2d derivative;
  };
  [[nodiscard]] Ray ray(int x, int y) const {
    if (rays_.empty()) {
      return {{(x - camera_.cx) / camera_.fx, (y - camera_.cy) / camera_.fy},
              Eigen::Vector2d(1.0 / camera_.fx, 1.0 / camera_.fy).asDiagonal()};
    }
    const auto& stored = rays_[static_cast<std::size_t>(y * camera_.width + x)];
    return {stored.col(0).cast<double>(), stored.rightCols<2>().cast<double>()};
  }

  // Outline in the image of a plane, convex polygon of the optical frame, in coordinates that
  // start at the first pixel's corner; empty where it is out of view.
  [[nodiscard]] Polygon2d outline(std::vector<Eigen::Vector3d> corners) const;

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }

 private:
  PinholeCamera camera_;
  std::vector<Eigen::Vector3d> view_planes_;      // inward normals of a pyramid that holds the view
  std::vector<Eigen::Matrix<float, 2, 3>> rays_;  // row by row; empty without distortion
};

class CameraCanvas {
 public:
  CameraCanvas(const CameraLens& lens, cv::Mat& mono8);

  // Nothing is painted where the back is seen.
  void paint(const Facet& facet, const Eigen::Isometry3d& to_camera);
  void paint(const Print& print, const Eigen::Isometry3d& to_camera);

 private:
  const CameraLens& lens_;
  cv::Mat& image_;
  PolygonRaster raster_;
};

}  // namespace camera_sim
