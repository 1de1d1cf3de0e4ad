// SPDX-License-Identifier: BSD-3-Clause
// What prf_control takes from messages, and what its controller commands then.
#include <jaco_kinematics/jaco_arm.hpp>
#include <memory>
#include <prf_ros/conversions.hpp>

#include "../../prf_control/node/messages.hpp"
#include "fuzz_target.hpp"

namespace {

using namespace prf_control;

NodeParams params() {
  NodeParams result{};
  for (int i = 1; i <= 7; ++i) {
    result.robot.joints.push_back("j2s7s300_joint_" + std::to_string(i));
  }
  result.controller.joints = result.robot.joints;
  result.controller.max_tracking_error = 0.2;
  result.controller.max_wait = 0.3;
  FollowerParams& follower = result.controller.follower;
  follower.velocity_scale = 0.95;
  follower.acceleration = 4.0;
  follower.max_joint_step = 0.3;
  follower.far_position = 0.1;
  follower.far_orientation = 0.5;
  follower.damping = 0.1;
  follower.orientation_weight = 0.2;
  follower.branch_patience = 1.0;
  result.robot.base_link = "j2s7s300_link_base";
  result.robot.tip_link = "j2s7s300_end_effector";
  result.robot.kinematics = std::make_shared<jaco_kinematics::JacoArm>();
  return result;
}

void check(const std::vector<ControlResult>& results, const NodeParams& node) {
  for (const ControlResult& result : results) {
    (void)status_message(result);
    if (!result.command) continue;
    fuzz::expect(result.command->position.allFinite() && result.command->velocity.allFinite(),
                 "every command is finite");
    (void)command_message(result, node);
  }
}

}  // namespace

FUZZ_TARGET(control_messages) {
  static const NodeParams node = params();
  ArmController controller(node.robot.kinematics, node.controller);
  fuzz::for_each_message(bytes, [&](int kind, fuzz::Bytes part) {
    fuzz::accepts([&] {
      sensor_msgs::JointState joints;
      trajectory_msgs::MultiDOFJointTrajectory setpoint;
      if (kind % 2 == 0 && fuzz::read(part, joints)) {
        const JointReading reading = to_sample(joints, node.robot.joints);
        fuzz::expect(reading.refusal.size() < 2000, "a refusal quotes in a few words");
        if (reading.sample) check(controller.add_joints(*reading.sample), node);
      } else if (kind % 2 == 1 && fuzz::read(part, setpoint)) {
        const auto stamp = prf_ros::to_core(setpoint.header.stamp);
        check(controller.add_setpoint(stamp, to_setpoint(setpoint, node)), node);
      }
    });
  });
}
