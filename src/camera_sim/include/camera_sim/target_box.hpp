// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace camera_sim {

/// A solid cuboid: pose of its centre in the platform frame (in the cart's frame for what the cart
/// carries), edge lengths along its axes, m.
struct Cuboid {
  Eigen::Isometry3d pose_in_platform = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// Deck of the platform: its surface is the plane z = 0 of the platform frame.
[[nodiscard]] Cuboid deck();
/// Chassis of the cart, in the cart's frame; it stands below the default place of the box.
[[nodiscard]] Cuboid cart_chassis();

/// Open box on a post, fixed to the platform or to a cart. With yaw 0 it opens toward -x; a tag is
/// on the inside of its back wall, its face toward the opening. Platform frame: centre of the
/// deck's surface, x forward, z up; a cart's frame is where the platform's is until the cart is
/// pushed. Tag frame: origin at the tag's centre, x right, y up, z out of the printed face, as seen
/// by a viewer in front. Lengths in metres.
struct TargetBox {
  Eigen::Vector3d tag_position_in_platform{0.89, 0.0, 1.30};
  double yaw = 0.0;        ///< rad, of box, tag and post about the vertical through the tag
  double tag_size = 0.10;  ///< edge of the tag's black border
  double tag_above_box_centre = 0.07;
  double inner_width = 0.30;  ///< along platform y and z
  double inner_depth = 0.20;  ///< along platform x
  double wall_thickness = 0.005;
  double post_width = 0.06;  ///< square column from the deck or the cart to the box
  bool on_cart = false;      ///< box and post are on a cart; the floor is the plane z = 0
  bool obstructed = false;   ///< another post stands on the deck before the box, see obstacle()

  /// Throws std::invalid_argument with name, value and bound.
  void validate() const;

  [[nodiscard]] Eigen::Isometry3d tag_in_platform() const;
  /// Moves and turns the box so that its tag has this position and yaw. The box stays upright: a
  /// tilt of the pose is not used.
  void place_tag(const Eigen::Isometry3d& tag_in_platform);
  /// Frame at the centre of the box's hollow: the platform's axes turned by yaw about z.
  [[nodiscard]] Eigen::Isometry3d box_in_platform() const;
  /// Back, left, right, top, bottom.
  [[nodiscard]] std::vector<Cuboid> walls() const;
  [[nodiscard]] Cuboid post() const;
  /// The post before the box if obstructed, which moves with what carries the box: on its right, as
  /// seen by a viewer in front of the tag, where it hides the tag from no viewer on its left.
  [[nodiscard]] Cuboid obstacle() const;
  /// What carries the box: the post and, if on_cart, the cart's chassis.
  [[nodiscard]] std::vector<Cuboid> support() const;
};

}  // namespace camera_sim
