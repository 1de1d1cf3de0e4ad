// SPDX-License-Identifier: BSD-3-Clause
// A shaded picture in the making; everything is given in world.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "camera_sim/pinhole_camera.hpp"
#include "camera_sim/triangle_mesh.hpp"
#include "camera_sim/z_buffer.hpp"

namespace scene_drawing {

// Where shadows fall: a rectangle of the plane z = 0 around the platform's origin.
struct Ground {
  Eigen::Vector2d size;
  camera_sim::Colour in_shadow;
};

class SceneCanvas {
 public:
  SceneCanvas(const camera_sim::PinholeCamera& camera, const Eigen::Isometry3d& camera_in_world,
              const Eigen::Isometry3d& platform, const Ground& ground);

  void draw(const camera_sim::Mesh& mesh, const Eigen::Isometry3d& pose,
            const camera_sim::Colour& colour);
  // The same, with its shadow.
  void draw_solid(const camera_sim::Mesh& mesh, const Eigen::Isometry3d& pose,
                  const camera_sim::Colour& colour);

  [[nodiscard]] cv::Mat finish() const { return buffer_.finish(); }

 private:
  void draw_shadow(const camera_sim::Triangle& in_platform);

  camera_sim::ZBuffer buffer_;
  Eigen::Isometry3d world_to_camera_;
  Eigen::Isometry3d platform_;
  Ground ground_;
};

}  // namespace scene_drawing
