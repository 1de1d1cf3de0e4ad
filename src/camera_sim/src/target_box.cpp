// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/target_box.hpp"

#include <cmath>
#include <prf_core/require.hpp>
#include <string>

namespace camera_sim {
namespace {

Cuboid cuboid_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  Cuboid cuboid;
  cuboid.pose_in_platform.translation() = centre;
  cuboid.size = size;
  return cuboid;
}

constexpr double kFarthest = 10.0;                     // m
const Eigen::Vector3d kDeckSize(2.4, 1.8, 0.1);        // m
const Eigen::Vector3d kChassisSize(0.45, 0.50, 0.12);  // m
const Eigen::Vector3d kChassisCentre(0.86, 0.0, 0.14);

}  // namespace

Cuboid deck() { return cuboid_at({0.0, 0.0, -0.5 * kDeckSize.z()}, kDeckSize); }
Cuboid cart_chassis() { return cuboid_at(kChassisCentre, kChassisSize); }

void TargetBox::validate() const {
  for (Eigen::Index i = 0; i < 3; ++i) {
    prf_core::require_between("target.tag_position_in_platform[" + std::to_string(i) + "]",
                              tag_position_in_platform[i], -kFarthest, kFarthest, "m");
  }
  prf_core::require_between("target.yaw", yaw, -2.0 * M_PI, 2.0 * M_PI, "rad");
  prf_core::require_between("target.tag_size", tag_size, 0.005, 5.0, "m");
  prf_core::require_between("target.inner_width", inner_width, 0.005, kFarthest, "m");
  prf_core::require_between("target.inner_depth", inner_depth, 0.001, kFarthest, "m");
  prf_core::require_between("target.wall_thickness", wall_thickness, 0.0005, 0.5, "m");
  prf_core::require_between("target.post_width", post_width, 0.001, kFarthest, "m");
  const double reach = std::abs(tag_above_box_centre) + 0.5 * tag_size;
  prf_core::require(reach <= 0.5 * inner_width, "target.tag_above_box_centre", tag_above_box_centre,
                    "so that the tag is on the back wall");
  const double box_bottom =
      tag_position_in_platform.z() - tag_above_box_centre - 0.5 * inner_width - wall_thickness;
  const double foot = on_cart ? kChassisCentre.z() + 0.5 * kChassisSize.z() : 0.0;
  prf_core::require_positive("height of the target box over its support", box_bottom - foot, "m");
}

Eigen::Isometry3d TargetBox::tag_in_platform() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear().col(0) = -Eigen::Vector3d::UnitY();
  pose.linear().col(1) = Eigen::Vector3d::UnitZ();
  pose.linear().col(2) = -Eigen::Vector3d::UnitX();
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * pose.linear();
  pose.translation() = tag_position_in_platform;
  return pose;
}

void TargetBox::place_tag(const Eigen::Isometry3d& tag_in_platform) {
  const Eigen::Vector3d into_tag = -tag_in_platform.linear().col(2);
  tag_position_in_platform = tag_in_platform.translation();
  yaw = std::atan2(into_tag.y(), into_tag.x());
}

Eigen::Isometry3d TargetBox::box_in_platform() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() =
      tag_position_in_platform -
      pose.linear() * Eigen::Vector3d(0.5 * inner_depth, 0.0, tag_above_box_centre);
  return pose;
}

std::vector<Cuboid> TargetBox::walls() const {
  const double wall_offset = 0.5 * (inner_width + wall_thickness);
  const double outer_width = inner_width + 2.0 * wall_thickness;
  const Eigen::Vector3d back(0.5 * (inner_depth + wall_thickness), 0.0, 0.0);
  const Eigen::Vector3d left(0.0, wall_offset, 0.0);
  const Eigen::Vector3d top(0.0, 0.0, wall_offset);
  const Eigen::Vector3d back_size(wall_thickness, outer_width, outer_width);
  const Eigen::Vector3d side_size(inner_depth, wall_thickness, inner_width);
  const Eigen::Vector3d lid_size(inner_depth, outer_width, wall_thickness);
  std::vector<Cuboid> walls{cuboid_at(back, back_size), cuboid_at(left, side_size),
                            cuboid_at(-left, side_size), cuboid_at(top, lid_size),
                            cuboid_at(-top, lid_size)};
  for (Cuboid& wall : walls) wall.pose_in_platform = box_in_platform() * wall.pose_in_platform;
  return walls;
}

Cuboid TargetBox::post() const {
  const Eigen::Isometry3d box = box_in_platform();
  const double centre = box.translation().z();
  const double top = centre - 0.5 * inner_width - wall_thickness;
  const double foot = on_cart ? kChassisCentre.z() + 0.5 * kChassisSize.z() : 0.0;
  const double x = 0.5 * inner_depth + wall_thickness - 0.5 * post_width;
  Cuboid post =
      cuboid_at({x, 0.0, 0.5 * (foot + top) - centre}, {post_width, post_width, top - foot});
  post.pose_in_platform = box * post.pose_in_platform;
  return post;
}

// Beside the straight way to the tag, in the way of one that comes from the right.
Cuboid TargetBox::obstacle() const {
  constexpr double kRight = 0.20;   // m, of the tag's centre
  constexpr double kBefore = 0.26;  // m, the tag's face
  constexpr double kWidth = 0.04;   // m
  constexpr double kAbove = 0.25;   // m, of its top over the tag's centre
  const double height = tag_position_in_platform.z() + kAbove;
  const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitZ());
  Cuboid post = cuboid_at(tag_position_in_platform + turn * Eigen::Vector3d(-kBefore, -kRight, 0.0),
                          {kWidth, kWidth, height});
  post.pose_in_platform.translation().z() = 0.5 * height;
  post.pose_in_platform.linear() = turn.toRotationMatrix();
  return post;
}

std::vector<Cuboid> TargetBox::support() const {
  return on_cart ? std::vector<Cuboid>{post(), cart_chassis()} : std::vector<Cuboid>{post()};
}

}  // namespace camera_sim
