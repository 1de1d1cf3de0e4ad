// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "camera_sim/pinhole_camera.hpp"
#include "camera_sim/triangle_mesh.hpp"

namespace camera_sim {

using Colour = Eigen::Vector3d;  // red, green, blue in 0..1

// Image of triangles with hidden surfaces removed by depth. A lens that distorts moves the corners
// only: triangles must be small then.
class ZBuffer {
 public:
  // The image is kOversampling times as fine as the camera's until finish().
  ZBuffer(const PinholeCamera& camera, const Colour& background);

  // A triangle in the optical frame; left out if seen from behind or not wholly in front of
  // the camera.
  void draw(const Triangle& triangle, const Colour& colour);
  // BGR, averaged down to the camera's resolution.
  [[nodiscard]] cv::Mat finish() const;

 private:
  static constexpr int kOversampling = 3;

  PinholeCamera camera_;  // of the fine image
  cv::Mat inverse_depth_;
  cv::Mat image_;
};

}  // namespace camera_sim
