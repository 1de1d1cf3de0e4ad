// SPDX-License-Identifier: BSD-3-Clause
#include "scene_facets.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace camera_sim {
namespace {

using Eigen::Vector3d;

const Vector3d kTowardLight = Vector3d(-0.45, 0.30, 0.84).normalized();
constexpr double kAmbient = 0.6;
constexpr double kBoxAlbedo = 165.0;
constexpr double kPostAlbedo = 120.0;
constexpr double kObstacleAlbedo = 70.0;
constexpr double kDeckAlbedo = 105.0;
constexpr double kChassisAlbedo = 90.0;

const Vector3d kRoomHalf(4.5, 4.0, 1.9);
constexpr double kPlatformHeight = 0.6;  // m, of the deck over the floor

Vector3d room_centre(const TargetBox& target) {
  return {0.5, 0.0, kRoomHalf.z() - (target.on_cart ? 0.0 : kPlatformHeight)};
}

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

constexpr std::uint64_t kPosterStream = 0x706f737465720000;  // apart from the seed's other draws
constexpr double kLift = 1e-3;                               // m, of each poster off the last

GridTexture random_texture(std::mt19937_64& generator) {
  const auto below = [&](std::uint64_t count) { return generator() % count; };
  const int columns = static_cast<int>(4 + below(7));
  const auto cells = static_cast<std::size_t>(columns) * (4 + below(7));
  std::vector<unsigned char> greys;
  for (std::size_t i = 0; i < cells; ++i) {
    greys.push_back(
        static_cast<unsigned char>(below(3) == 0 ? 20 + below(220) : below(2) * 180 + 40));
  }
  return {columns, greys};
}

}  // namespace

std::array<Vector3d, 4> Print::corners() const {
  const double x = 0.5 * cell * texture.columns(), y = 0.5 * cell * texture.rows();
  return {pose * Vector3d(-x, -y, 0.0), pose * Vector3d(x, -y, 0.0), pose * Vector3d(x, y, 0.0),
          pose * Vector3d(-x, y, 0.0)};
}

Body platform_body() {
  return make_body(deck(), kDeckAlbedo, {Vector3d::UnitZ(), Vector3d::Zero()});
}

std::vector<Body> target_bodies(const TargetBox& target) {
  const Eigen::Isometry3d box = target.box_in_platform();
  const Vector3d half(0.5 * target.inner_depth, 0.5 * target.inner_width, 0.5 * target.inner_width);
  const auto plane_of_box = [&](const Vector3d& outward, double distance) {
    const Vector3d inward = -(box.linear() * outward);
    return Eigen::Hyperplane<double, 3>(inward, box.translation() - distance * inward);
  };
  const std::vector<Cuboid> walls = target.walls();
  const double outside = half.z() + target.wall_thickness;
  std::vector<Body> bodies;
  if (target.on_cart) {
    const Cuboid chassis = cart_chassis();
    const Vector3d top = chassis.pose_in_platform * Vector3d(0.0, 0.0, 0.5 * chassis.size.z());
    bodies.push_back(make_body(chassis, kChassisAlbedo, {Vector3d::UnitZ(), top}));
  }
  bodies.push_back(
      make_body(target.post(), kPostAlbedo, plane_of_box(-Vector3d::UnitZ(), outside)));
  const std::array<Vector3d, 5> outward{Vector3d::UnitX(), Vector3d::UnitY(), -Vector3d::UnitY(),
                                        Vector3d::UnitZ(), -Vector3d::UnitZ()};
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double distance = half.dot(outward[i].cwiseAbs());
    bodies.push_back(make_body(walls[i], kBoxAlbedo, plane_of_box(outward[i], distance)));
    bodies.back().carries_tag = i == 0;
  }
  if (target.obstructed) {
    // In front of all others: its own plane away from the box has it behind and nothing before.
    const Cuboid post = target.obstacle();
    const Vector3d toward_box = post.pose_in_platform.linear().col(0);
    bodies.push_back(make_body(
        post, kObstacleAlbedo,
        {toward_box, Vector3d(post.pose_in_platform * Vector3d(0.5 * post.size.x(), 0.0, 0.0))}));
    std::rotate(bodies.begin(), bodies.end() - 1, bodies.end());
  }
  return bodies;
}

Print tag_print(const TargetBox& target) {
  const GridTexture texture = tag_texture();
  return {target.tag_in_platform(), target.tag_size / black_side(texture), texture};
}

std::vector<Facet> room_facets(const TargetBox& target) {
  const Vector3d centre = room_centre(target);
  const Vector3d a = kRoomHalf.x() * Vector3d::UnitX(), b = kRoomHalf.y() * Vector3d::UnitY(),
                 c = kRoomHalf.z() * Vector3d::UnitZ();
  std::vector<Facet> facets;
  append_wall(facets, centre + a, -b, c, 150.0, 6, 3);
  append_wall(facets, centre - a, b, c, 150.0, 6, 3);
  append_wall(facets, centre + b, a, c, 140.0, 6, 3);
  append_wall(facets, centre - b, -a, c, 140.0, 6, 3);
  append_wall(facets, centre - c, a, b, 95.0, 9, 8);
  append_wall(facets, centre + c, a, -b, 190.0, 5, 4);
  return facets;
}

// Most hang where the robot looks; the others beside and behind it.
std::vector<Print> room_posters(const TargetBox& target, const Clutter& clutter) {
  std::mt19937_64 generator(clutter.seed ^ kPosterStream);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(generator() >> 11), -53);
  };
  std::vector<Print> posters;
  for (int i = 0; i < clutter.posters; ++i) {
    const double turn = i % 2 == 0 ? 0.0 : M_PI_2 * std::floor(uniform(0.0, 4.0));
    const Eigen::AngleAxisd about_z(turn, Vector3d::UnitZ());
    const Vector3d depth = (about_z * Vector3d::UnitX()).cwiseAbs();
    const double wall = kRoomHalf.dot(depth) - kLift * (i + 1);
    const double width = kRoomHalf.dot(Vector3d(depth.y(), depth.x(), 0.0));
    Print poster{Eigen::Isometry3d::Identity(), uniform(0.02, 0.08), random_texture(generator)};
    poster.pose.linear() = (about_z * Eigen::AngleAxisd(-M_PI_2, Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(M_PI_2, Vector3d::UnitX()))
                               .toRotationMatrix();
    poster.pose.translation() =
        room_centre(target) +
        about_z * Vector3d(wall, uniform(-0.8, 0.8) * width, uniform(-0.7, 0.7) * kRoomHalf.z());
    posters.push_back(poster);
  }
  return posters;
}

}  // namespace camera_sim
