// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <prf_core/require.hpp>
#include <prf_ros/private_parameters.hpp>

namespace prf_control {

void NodeParams::validate() const {
  controller.validate();
  prf_core::require_between("tick_period", tick_period, 0.001, 0.1, "s");
}

NodeParams load_params(const ros::NodeHandle& private_handle) {
  prf_ros::PrivateParameters values(private_handle);
  NodeParams params{};
  FollowerParams& follower = params.controller.follower;
  follower.velocity_scale = values.number("velocity_scale");
  follower.acceleration = values.number("acceleration");
  follower.max_joint_step = values.number("max_joint_step");
  follower.far_position = values.number("far_position");
  follower.far_orientation = values.number("far_orientation");
  follower.damping = values.number("damping");
  follower.orientation_weight = values.number("orientation_weight");
  follower.branch_patience = values.number("branch_patience");
  params.controller.max_tracking_error = values.number("max_tracking_error");
  params.controller.max_wait = values.number("max_wait");
  params.tick_period = values.number("tick_period");
  const std::string robot = values.text("robot");
  values.refuse_unknown();
  params.robot = prf_robots::load_robot(prf_robots::robot_folder(robot));
  params.controller.joints = params.robot.joints;
  params.validate();
  return params;
}

}  // namespace prf_control
