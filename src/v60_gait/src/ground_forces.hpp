// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace v60_gait {

/// Wrench about the centre of mass, in axes with z up.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< Nm
};

/// Forces f_i at feet r_i (from the centre of mass) that come closest to a wrench:
///
///   min |sum f_i - F|^2 + |sum r_i x f_i - T|^2 / l^2 + a sum |f_i|^2
///   s.t. f_i,z >= 0,  |(f_i,x f_i,y)| <= mu f_i,z
///
/// by 60 steps of the projected gradient from `guess`, one force per foot.
[[nodiscard]] std::vector<Eigen::Vector3d> distribute_wrench(
    const Wrench& wanted, const std::vector<Eigen::Vector3d>& feet, double friction,
    const std::vector<Eigen::Vector3d>& guess);

}  // namespace v60_gait
