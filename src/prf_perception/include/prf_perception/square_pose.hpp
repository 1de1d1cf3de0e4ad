// SPDX-License-Identifier: BSD-3-Clause
// Pose of a square marker from its four corners, with covariance.
//
// Minimises the reprojection error  e = sum_i | p_i - project(R m_i + t) |^2  over the rotation R
// and the translation t of the marker in the optical frame. Seen from afar e has two minima,
// mirrored about the line of sight (Schweighofer and Pinz, PAMI 2006, doi 10.1109/TPAMI.2006.252):
// both are searched and the lower one is returned.
//
// Covariance: J is the Jacobian of the corners in (t, rotation vector about the optical axes), s
// the standard deviation of a corner (corner_sigma sqrt(100 px / mean side)), d the rotation from
// the returned minimum to the other one and w the probability that the other one is right, w = 1 /
// (1 + exp((e_other - e) / (2 s^2))):
//   P = s^2 (J^T J)^-1 + diag(floors)^2 + w d d^T (rotation block).
// J carries the dependence on distance and view angle.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "prf_perception/camera.hpp"

namespace prf_perception {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Lower left, lower right, upper right, upper left, as a viewer in front of the marker sees them.
using Corners = std::array<Eigen::Vector2d, 4>;

struct CornerErrorModel {
  double corner_sigma = 0.0;       // of one corner of a square with sides of 100 px, px
  double position_floor = 0.0;     // standard deviation that is added to every view's, m
  double orientation_floor = 0.0;  // the same, rad

  void validate() const;  // throws std::invalid_argument with name, value and bound
};

// Marker axes: x right, y up, z out of the face; origin at the centre.
struct SquarePose {
  Eigen::Isometry3d marker_in_camera = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  // (x y z, rotation vector about the optical axes)
  double reprojection_error = 0.0;         // root mean square over the corners, px
  double other_error = 0.0;                // of the other minimum, px; infinite when there is none
  std::optional<Eigen::Isometry3d> other_in_camera;  // the marker's pose at the other minimum

  // reprojection_error / other_error, 0 .. 1: how alike the two minima are; 0 when there is one.
  [[nodiscard]] double ambiguity() const;
};

// side: of the marker, m. guess: start of the minimisation, a pose from which it converges to one
// of the minima, such as a tag library's own estimate. Nothing is returned when the corners are not
// finite, degenerate, or fit no marker in front of the camera.
[[nodiscard]] std::optional<SquarePose> estimate_square_pose(const Corners& corners,
                                                             const CameraIntrinsics& camera,
                                                             double side,
                                                             const Eigen::Isometry3d& guess,
                                                             const CornerErrorModel& model);

// Pixels of the marker's corners in the ideal pinhole, without lens distortion.
[[nodiscard]] Corners project_corners(const Eigen::Isometry3d& marker_in_camera, double side,
                                      const CameraIntrinsics& camera);

}  // namespace prf_perception
