// SPDX-License-Identifier: BSD-3-Clause
#include "scene_canvas.hpp"

#include <algorithm>
#include <utility>

namespace scene_drawing {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

const Vector3d kTowardLight = Vector3d(-0.20, -0.32, 0.93).normalized();
constexpr double kAmbient = 0.55;
const camera_sim::Colour kBackground(0.96, 0.97, 0.98);
constexpr double kLift = 0.004;  // m, of the shadow

camera_sim::Colour shaded(const camera_sim::Colour& colour, const camera_sim::Triangle& triangle) {
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double lit = std::max(0.0, normal.normalized().dot(kTowardLight));
  return colour * (kAmbient + (1.0 - kAmbient) * lit);
}

}  // namespace

SceneCanvas::SceneCanvas(const camera_sim::PinholeCamera& camera, const Isometry3d& camera_in_world,
                         const Isometry3d& platform, const Ground& ground)
    : buffer_(camera, kBackground),
      world_to_camera_(camera_in_world.inverse()),
      platform_(platform),
      ground_(ground) {}

void SceneCanvas::draw(const camera_sim::Mesh& mesh, const Isometry3d& pose,
                       const camera_sim::Colour& colour) {
  for (const camera_sim::Triangle& triangle : mesh) {
    const camera_sim::Triangle in_world = camera_sim::transformed(pose, triangle);
    buffer_.draw(camera_sim::transformed(world_to_camera_, in_world), shaded(colour, in_world));
  }
}

void SceneCanvas::draw_solid(const camera_sim::Mesh& mesh, const Isometry3d& pose,
                             const camera_sim::Colour& colour) {
  draw(mesh, pose, colour);
  const Isometry3d in_platform = platform_.inverse() * pose;
  for (const camera_sim::Triangle& triangle : mesh)
    draw_shadow(camera_sim::transformed(in_platform, triangle));
}

void SceneCanvas::draw_shadow(const camera_sim::Triangle& in_platform) {
  const Vector3d light = platform_.linear().transpose() * kTowardLight;
  camera_sim::Triangle shadow;
  for (std::size_t i = 0; i < 3; ++i) {
    shadow[i] = in_platform[i] - in_platform[i].z() / light.z() * light;
    if (in_platform[i].z() < 0.0 ||
        (shadow[i].head<2>().array().abs() > 0.5 * ground_.size.array()).any()) {
      return;
    }
    shadow[i].z() = kLift;
  }
  const bool faces_down = (shadow[1] - shadow[0]).cross(shadow[2] - shadow[0]).z() < 0.0;
  if (faces_down) std::swap(shadow[1], shadow[2]);
  buffer_.draw(
      camera_sim::transformed(world_to_camera_, camera_sim::transformed(platform_, shadow)),
      ground_.in_shadow);
}

}  // namespace scene_drawing
