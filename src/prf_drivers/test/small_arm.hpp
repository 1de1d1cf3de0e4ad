// SPDX-License-Identifier: BSD-3-Clause
// A planar arm: joints a, b, c about z, three links of 0.4 m along x, each a bar 40 mm wide that
// leaves 50 mm free at both ends. It stands on a ball of 50 mm. Joint d moves a flag that is not
// the arm's.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace prf_drivers {

inline const std::vector<std::string> kSmallArm = {"a", "b", "c"};

inline std::string small_arm() {
  const std::string bar =
      "<collision><origin xyz='0.2 0 0'/><geometry><box size='0.3 0.04 0.04'/></geometry>"
      "</collision>";
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& xyz) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='" + xyz +
           "'/><axis xyz='0 0 1'/><limit lower='-3' upper='2.5' velocity='1' effort='9'/></joint>";
  };
  return "<robot name='small'><link name='base'><collision><geometry><sphere radius='0.05'/>"
         "</geometry></collision></link><link name='one'>" +
         bar + "</link><link name='two'>" + bar + "</link><link name='three'>" + bar +
         "</link><link name='flag'><collision><origin xyz='0 0 0.3'/><geometry><cylinder "
         "radius='0.02' length='0.2'/></geometry></collision></link>" +
         joint("a", "continuous", "base", "one", "0 0 0") +
         joint("b", "revolute", "one", "two", "0.4 0 0") +
         joint("c", "revolute", "two", "three", "0.4 0 0") +
         joint("d", "prismatic", "base", "flag", "0.8 0.3 0") + "</robot>";
}

inline Eigen::VectorXd three(double a, double b, double c) { return Eigen::Vector3d(a, b, c); }

}  // namespace prf_drivers
