// SPDX-License-Identifier: BSD-3-Clause
// Arms for the tests, as URDF.
#pragma once

#include <string>

namespace arm_kinematics {

// An arm of so many joints: the first is continuous, the last one of eight prismatic. Joint k turns
// about z, y, y, x, y, x, y in this order.
inline std::string arm_urdf(int joints) {
  const std::string axes[] = {"0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0", "0 1 0"};
  std::string text = "<robot name='arm'><link name='base'/>";
  for (int k = 1; k <= joints; ++k) {
    const std::string number = std::to_string(k);
    const std::string parent = k == 1 ? "base" : "l" + std::to_string(k - 1);
    const bool prismatic = k == 8;
    const std::string type = k == 1 ? "continuous" : prismatic ? "prismatic" : "revolute";
    text += "<link name='l" + number + "'/><joint name='j" + number + "' type='" + type +
            "'><parent link='" + parent + "'/><child link='l" + number +
            "'/><origin xyz='0.02 0.01 0.2' rpy='0.1 0 0.2'/><axis xyz='" + axes[(k - 1) % 7] +
            "'/>";
    if (k == 1) {
      text += "<limit velocity='1.5' effort='10'/>";
    } else if (prismatic) {
      text += "<limit lower='-0.1' upper='0.1' velocity='0.5' effort='10'/>";
    } else {
      text += "<limit lower='-2.0' upper='2.5' velocity='1.5' effort='10'/>";
    }
    text += "</joint>";
  }
  return text + "<link name='tip'/><joint name='mount' type='fixed'><parent link='l" +
         std::to_string(joints) + "'/><child link='tip'/><origin xyz='0 0 0.1'/></joint></robot>";
}

}  // namespace arm_kinematics
