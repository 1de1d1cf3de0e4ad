// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include <prf_ros/private_parameters.hpp>

#include "adapter_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "driver_adapter");
  ros::NodeHandle node;
  return prf_ros::run([&node] {
    prf_drivers::AdapterNode adapter(node, prf_drivers::load_adapter(node, ros::NodeHandle("~")));
    ros::spin();
  });
}
