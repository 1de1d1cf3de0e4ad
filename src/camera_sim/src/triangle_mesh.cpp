// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/triangle_mesh.hpp"

#include <cmath>

namespace camera_sim {
namespace {

using Eigen::Vector3d;

constexpr int kSegments = 40;  // around
constexpr int kRings = 16;     // from pole to pole

void append_quad(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
                 Mesh& mesh) {
  mesh.push_back({a, b, c});
  mesh.push_back({a, c, d});
}

Vector3d on_circle(double radius, int segment, double z) {
  const double angle = 2.0 * M_PI * segment / kSegments;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace

Triangle transformed(const Eigen::Isometry3d& pose, const Triangle& triangle) {
  return {pose * triangle[0], pose * triangle[1], pose * triangle[2]};
}

Mesh box_mesh(const Eigen::Vector3d& size) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      const Vector3d n = side * size[axis] * Vector3d::Unit(axis);
      const Vector3d u = 0.5 * size[(axis + 1) % 3] * Vector3d::Unit((axis + 1) % 3);
      const Vector3d v =
          std::copysign(0.5, side) * size[(axis + 2) % 3] * Vector3d::Unit((axis + 2) % 3);
      append_quad(n - u - v, n + u - v, n + u + v, n - u + v, mesh);
    }
  }
  return mesh;
}

Mesh cylinder_mesh(double radius, double length) {
  Mesh mesh;
  const double top = 0.5 * length;
  for (int i = 0; i < kSegments; ++i) {
    const Vector3d a = on_circle(radius, i, -top), b = on_circle(radius, i + 1, -top);
    const Vector3d c = on_circle(radius, i + 1, top), d = on_circle(radius, i, top);
    append_quad(a, b, c, d, mesh);
    mesh.push_back({d, c, Vector3d(0.0, 0.0, top)});
    mesh.push_back({b, a, Vector3d(0.0, 0.0, -top)});
  }
  return mesh;
}

Mesh sphere_mesh(double radius) {
  Mesh mesh;
  const auto point = [radius](int segment, int ring) {
    const double latitude = M_PI * ring / kRings - M_PI_2;
    return on_circle(radius * std::cos(latitude), segment, radius * std::sin(latitude));
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int i = 0; i < kSegments; ++i) {
      append_quad(point(i, ring), point(i + 1, ring), point(i + 1, ring + 1), point(i, ring + 1),
                  mesh);
    }
  }
  return mesh;
}

Mesh rectangle_mesh(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  Mesh mesh;
  append_quad({low.x(), low.y(), 0.0}, {high.x(), low.y(), 0.0}, {high.x(), high.y(), 0.0},
              {low.x(), high.y(), 0.0}, mesh);
  return mesh;
}

}  // namespace camera_sim
