// SPDX-License-Identifier: BSD-3-Clause
// A shaded picture in the making; everything is given in world.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "platform_sim/pinhole_camera.hpp"
#include "triangle_mesh.hpp"
#include "z_buffer.hpp"

namespace platform_sim {

// Where shadows fall: a rectangle of the plane z = 0 around the platform's origin.
struct Ground {
  Eigen::Vector2d size;
  Colour in_shadow;
};

class SceneCanvas {
 public:
  SceneCanvas(const PinholeCamera& camera, const Eigen::Isometry3d& camera_in_world,
              const Eigen::Isometry3d& platform, const Ground& ground);

  void draw(const Mesh& mesh, const Eigen::Isometry3d& pose, const Colour& colour);
  // The same, with its shadow.
  void draw_solid(const Mesh& mesh, const Eigen::Isometry3d& pose, const Colour& colour);

  [[nodiscard]] cv::Mat finish() const { return buffer_.finish(); }

 private:
  void draw_shadow(const Triangle& in_platform);

  ZBuffer buffer_;
  Eigen::Isometry3d world_to_camera_;
  Eigen::Isometry3d platform_;
  Ground ground_;
};

}  // namespace platform_sim
