// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include <prf_ros/private_parameters.hpp>

#include "params.hpp"
#include "skill_planner_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "skill_planner");
  return prf_ros::run([] {
    elte_planner::SkillPlannerNode node(elte_planner::load_params(ros::NodeHandle("~")));
    ros::spin();
  });
}
