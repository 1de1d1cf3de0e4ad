// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "physics/multibody_from_urdf.hpp"

namespace platform_sim {

inline std::string inertial(double mass, const std::string& xyz, const std::string& moments) {
  return "<inertial><origin xyz='" + xyz + "'/><mass value='" + std::to_string(mass) +
         "'/><inertia " + moments + "/></inertial>";
}

/// Two rods in series, off their joints' planes, the second with a fixed part and rotated frames.
inline std::string two_link_robot() {
  return "<robot name='two'>"
         "<link name='base'/>"
         "<link name='upper'>" +
         inertial(2.0, "0.1 0.02 -0.3",
                  "ixx='0.06' ixy='0.002' ixz='0.001' iyy='0.05' iyz='-0.003' izz='0.02'") +
         "</link>"
         "<link name='lower'>" +
         inertial(1.0, "0 0.03 -0.2",
                  "ixx='0.02' ixy='0' ixz='0.001' iyy='0.02' iyz='0' izz='0.01'") +
         "</link>"
         "<link name='weight'>" +
         inertial(0.5, "0.01 0 0", "ixx='0.002' ixy='0' ixz='0' iyy='0.002' iyz='0' izz='0.001'") +
         "</link>"
         "<link name='tip'/>"
         "<joint name='shoulder' type='revolute'><parent link='base'/><child link='upper'/>"
         "<origin xyz='0 0 1' rpy='0.3 0.1 -0.2'/><axis xyz='0 1 0'/>"
         "<limit lower='-3' upper='3' velocity='2' effort='60'/></joint>"
         "<joint name='elbow' type='continuous'><parent link='upper'/><child link='lower'/>"
         "<origin xyz='0.1 0 -0.5' rpy='-0.5 0.4 0.7'/><axis xyz='0.6 0.8 0'/>"
         "<limit velocity='1' effort='30'/></joint>"
         "<joint name='clamp' type='fixed'><parent link='lower'/><child link='weight'/>"
         "<origin xyz='0.05 0 -0.4' rpy='0.2 0.3 0.4'/></joint>"
         "<joint name='end' type='fixed'><parent link='weight'/><child link='tip'/>"
         "<origin xyz='0.1 0.2 0.3' rpy='1 0 0'/></joint>"
         "</robot>";
}

inline RobotSurface untouchable(const std::string& /*body*/) { return {"", {0, 0}, 0.5, 1e5, 1e3}; }

}  // namespace platform_sim
