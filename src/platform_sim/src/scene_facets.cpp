// SPDX-License-Identifier: BSD-3-Clause
#include "scene_facets.hpp"

#include <algorithm>
#include <cmath>

namespace platform_sim {
namespace {

using Eigen::Vector3d;

const Vector3d kTowardLight = Vector3d(-0.45, 0.30, 0.84).normalized();
constexpr double kAmbient = 0.6;
constexpr double kBoxAlbedo = 165.0;
constexpr double kPostAlbedo = 120.0;
constexpr double kDeckAlbedo = 105.0;

unsigned char shade(double albedo, const Vector3d& normal) {
  const double lit = std::max(0.0, normal.normalized().dot(kTowardLight));
  return static_cast<unsigned char>(albedo * (kAmbient + (1.0 - kAmbient) * lit));
}

Facet make_facet(const Vector3d& centre, const Vector3d& half_a, const Vector3d& half_b,
                 double albedo) {
  Facet facet;
  facet.corners = {centre - half_a - half_b, centre + half_a - half_b, centre + half_a + half_b,
                   centre - half_a + half_b};
  facet.grey = shade(albedo, facet.normal());
  return facet;
}

Body make_body(const Cuboid& cuboid, double albedo, const Eigen::Hyperplane<double, 3>& separator) {
  Body body;
  body.separator = separator;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Matrix3d axes =
          cuboid.pose_in_platform.linear() * (0.5 * cuboid.size).asDiagonal();
      const Vector3d centre = cuboid.pose_in_platform.translation() + side * axes.col(axis);
      body.facets.push_back(
          make_facet(centre, axes.col((axis + 1) % 3), side * axes.col((axis + 2) % 3), albedo));
    }
  }
  return body;
}

// One face of the room: base colour and panels of slightly different greys with gaps between.
void append_wall(std::vector<Facet>& facets, const Vector3d& centre, const Vector3d& half_a,
                 const Vector3d& half_b, double albedo, int panels_a, int panels_b) {
  facets.push_back(make_facet(centre, half_a, half_b, albedo));
  const Vector3d step_a = half_a / panels_a, step_b = half_b / panels_b;
  for (int i = 0; i < panels_a; ++i) {
    for (int j = 0; j < panels_b; ++j) {
      const int tone = (5 * i + 3 * j + i * j) % 7 - 3;
      const Vector3d middle =
          centre + (2 * i + 1 - panels_a) * step_a + (2 * j + 1 - panels_b) * step_b;
      facets.push_back(make_facet(middle, 0.96 * step_a, 0.96 * step_b, albedo + 4.0 * tone));
    }
  }
}

}  // namespace

std::vector<Body> platform_bodies(const TargetBox& target) {
  const Eigen::Isometry3d box = target.box_in_platform();
  const Vector3d half(0.5 * target.inner_depth, 0.5 * target.inner_width, 0.5 * target.inner_width);
  const auto plane_of_box = [&](const Vector3d& outward, double distance) {
    const Vector3d inward = -(box.linear() * outward);
    return Eigen::Hyperplane<double, 3>(inward, box.translation() - distance * inward);
  };
  const std::vector<Cuboid> walls = target.walls();
  const double outside = half.z() + target.wall_thickness;
  return {
      make_body(deck(), kDeckAlbedo, {Vector3d::UnitZ(), Vector3d::Zero()}),
      make_body(target.post(), kPostAlbedo, plane_of_box(-Vector3d::UnitZ(), outside)),
      make_body(walls[0], kBoxAlbedo, plane_of_box(Vector3d::UnitX(), half.x())),
      make_body(walls[1], kBoxAlbedo, plane_of_box(Vector3d::UnitY(), half.y())),
      make_body(walls[2], kBoxAlbedo, plane_of_box(-Vector3d::UnitY(), half.y())),
      make_body(walls[3], kBoxAlbedo, plane_of_box(Vector3d::UnitZ(), half.z())),
      make_body(walls[4], kBoxAlbedo, plane_of_box(-Vector3d::UnitZ(), half.z())),
  };
}

std::vector<Facet> room_facets() {
  const Vector3d centre(0.5, 0.0, 1.3);
  const Vector3d a = 4.5 * Vector3d::UnitX(), b = 4.0 * Vector3d::UnitY(),
                 c = 1.9 * Vector3d::UnitZ();
  std::vector<Facet> facets;
  append_wall(facets, centre + a, -b, c, 150.0, 6, 3);
  append_wall(facets, centre - a, b, c, 150.0, 6, 3);
  append_wall(facets, centre + b, a, c, 140.0, 6, 3);
  append_wall(facets, centre - b, -a, c, 140.0, 6, 3);
  append_wall(facets, centre - c, a, b, 95.0, 9, 8);
  append_wall(facets, centre + c, a, -b, 190.0, 5, 4);
  return facets;
}

}  // namespace platform_sim
