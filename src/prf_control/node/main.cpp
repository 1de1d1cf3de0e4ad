// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include <prf_ros/private_parameters.hpp>

#include "arm_controller_node.hpp"
#include "robot_description.hpp"

namespace {

constexpr double kDescriptionPatience = 5.0;  // [s], wall clock: a launch file may still set it

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "arm_controller");
  ros::NodeHandle node;
  return prf_ros::run([&node] {
    const prf_control::NodeParams params = prf_control::load_params(ros::NodeHandle("~"));
    prf_control::require_same_arm(
        prf_control::wait_for_robot_description(node, kDescriptionPatience), params.robot);
    prf_control::ArmControllerNode controller(node, params);
    ros::spin();
  });
}
