// SPDX-License-Identifier: BSD-3-Clause
#include "scenery.hpp"

#include "camera_sim/grid_texture.hpp"

namespace scene_drawing {
namespace {

using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

const camera_sim::Colour kFloor(0.88, 0.89, 0.90);
const camera_sim::Colour kFrame(0.72, 0.74, 0.77);
const camera_sim::Colour kBelt(0.36, 0.38, 0.41);
const camera_sim::Colour kStripe(0.46, 0.48, 0.51);
const camera_sim::Colour kRail(0.90, 0.62, 0.15);
const camera_sim::Colour kStrut(0.42, 0.46, 0.55);
const camera_sim::Colour kBox(0.87, 0.72, 0.48);
const camera_sim::Colour kPost(0.62, 0.62, 0.64);
const camera_sim::Colour kObstacle(0.80, 0.22, 0.16);
const camera_sim::Colour kChassis(0.25, 0.42, 0.62);
const camera_sim::Colour kWheel(0.15, 0.15, 0.16);

constexpr double kDeckHeight = 0.6;  // m, of the platform's deck over the floor
constexpr double kTile = 0.5;        // m
constexpr int kTiles = 7;            // to each side of the middle
constexpr double kLift = 0.002;      // m, of what lies on a surface
constexpr int kStripes = 10;         // across the belt
const Vector2d kBeltSize(2.30, 1.36);

Isometry3d at(double x, double y, double z) { return Isometry3d(Translation3d(x, y, z)); }

void draw_floor(double height, SceneCanvas& canvas) {
  const camera_sim::Mesh tile =
      camera_sim::rectangle_mesh(Vector2d::Zero(), Vector2d::Constant(kTile));
  for (int i = -kTiles; i < kTiles; ++i) {
    for (int j = -kTiles; j < kTiles; ++j) {
      const double tone = (i + j) % 2 == 0 ? 1.0 : 0.97;
      canvas.draw(tile, at(kTile * i, kTile * j, height), tone * kFloor);
    }
  }
}

// A round bar from one point of the world to another.
void draw_bar(const Vector3d& from, const Vector3d& to, double radius,
              const camera_sim::Colour& colour, SceneCanvas& canvas) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), to - from).matrix();
  pose.translation() = 0.5 * (from + to);
  canvas.draw(camera_sim::cylinder_mesh(radius, (to - from).norm()), pose, colour);
}

void draw_treadmill(const Isometry3d& platform, SceneCanvas& canvas) {
  const camera_sim::Cuboid plate = camera_sim::deck();
  canvas.draw(camera_sim::box_mesh(plate.size), platform * plate.pose_in_platform, kFrame);
  const double pitch = kBeltSize.x() / (2 * kStripes);
  for (int i = 0; i < 2 * kStripes; ++i) {
    const Vector2d low(-0.5 * kBeltSize.x() + i * pitch, -0.5 * kBeltSize.y());
    canvas.draw(camera_sim::rectangle_mesh(low, low + Vector2d(pitch, kBeltSize.y())),
                platform * at(0.0, 0.0, kLift), i % 2 == 0 ? kBelt : kStripe);
  }
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (0.5 * plate.size.y() - 0.04);
    canvas.draw_solid(camera_sim::box_mesh({plate.size.x(), 0.05, 0.05}),
                      platform * at(0.0, y, 0.025), kRail);
    for (const double end : {-1.0, 1.0}) {
      const Vector3d foot(0.75 * end, 0.55 * side, -kDeckHeight);
      const Vector3d joint = platform * Vector3d(0.95 * end, 0.55 * side, -plate.size.z());
      const Vector3d middle = 0.5 * (foot + joint);
      draw_bar(foot, middle, 0.06, kStrut, canvas);
      draw_bar(middle, joint, 0.035, kFrame, canvas);
    }
  }
}

void draw_cart(const Isometry3d& cart, SceneCanvas& canvas) {
  const camera_sim::Cuboid chassis = camera_sim::cart_chassis();
  canvas.draw_solid(camera_sim::box_mesh(chassis.size), cart * chassis.pose_in_platform, kChassis);
  constexpr double kRadius = 0.05;
  const camera_sim::Mesh wheel = camera_sim::cylinder_mesh(kRadius, 0.03);
  const Eigen::AngleAxisd axle(0.5 * M_PI, Vector3d::UnitX());
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const Vector3d hub =
          chassis.pose_in_platform.translation() +
          Vector3d(x * (0.5 * chassis.size.x() - 0.06), y * (0.5 * chassis.size.y() - 0.04), 0.0);
      canvas.draw_solid(wheel, cart * at(hub.x(), hub.y(), kRadius) * axle, kWheel);
    }
  }
}

void draw_tag(const Isometry3d& tag, double size, SceneCanvas& canvas) {
  const camera_sim::GridTexture texture = camera_sim::tag_texture();
  const double module = size / camera_sim::black_side(texture);
  const double half = 0.5 * module * texture.columns();
  for (int v = 0; v < texture.rows(); ++v) {
    for (int u = 0; u < texture.columns(); ++u) {
      const Vector2d low(u * module - half, half - (v + 1) * module);
      canvas.draw(camera_sim::rectangle_mesh(low, low + Vector2d::Constant(module)),
                  tag * at(0.0, 0.0, kLift),
                  camera_sim::Colour::Constant(texture.at(u, v) / 255.0));
    }
  }
}

}  // namespace

Ground ground_of(const camera_sim::TargetBox& target) {
  if (target.on_cart) return {Vector2d::Constant(2 * kTiles * kTile), 0.8 * kFloor};
  return {camera_sim::deck().size.head<2>(), 0.7 * kBelt};
}

void draw_scenery(const SceneState& state, const camera_sim::TargetBox& target,
                  SceneCanvas& canvas) {
  draw_floor(target.on_cart ? 0.0 : -kDeckHeight, canvas);
  if (target.on_cart) {
    draw_cart(state.carrier, canvas);
  } else {
    draw_treadmill(state.platform, canvas);
  }
  for (const camera_sim::Cuboid& wall : target.walls()) {
    canvas.draw_solid(camera_sim::box_mesh(wall.size), state.carrier * wall.pose_in_platform, kBox);
  }
  const camera_sim::Cuboid post = target.post();
  canvas.draw_solid(camera_sim::box_mesh(post.size), state.carrier * post.pose_in_platform, kPost);
  if (target.obstructed) {
    const camera_sim::Cuboid obstacle = target.obstacle();
    canvas.draw_solid(camera_sim::box_mesh(obstacle.size),
                      state.carrier * obstacle.pose_in_platform, kObstacle);
  }
  draw_tag(state.carrier * target.tag_in_platform(), target.tag_size, canvas);
}

}  // namespace scene_drawing
