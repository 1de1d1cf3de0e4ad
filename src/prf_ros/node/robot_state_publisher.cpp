// SPDX-License-Identifier: BSD-3-Clause
// tf of the robot, one message for every joint_states.
//
// It replaces Debian's robot_state_publisher. That node keeps only the newest of the joint_states
// that wait for it, and its library stamps fixed frames with the present time: the frames that the
// framework sees would depend on the load of the machine.
#include <geometry_msgs/TransformStamped.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <string>
#include <vector>

#include "prf_ros/conversions.hpp"
#include "prf_ros/frame_tree.hpp"
#include "prf_ros/private_parameters.hpp"

namespace prf_ros {
namespace {

constexpr unsigned kQueue = 1000;

std::vector<geometry_msgs::TransformStamped> to_messages(const std::vector<LinkFrame>& frames,
                                                         const ros::Time& stamp) {
  std::vector<geometry_msgs::TransformStamped> messages;
  for (const LinkFrame& frame : frames) {
    geometry_msgs::TransformStamped message;
    message.header.stamp = stamp;
    message.header.frame_id = frame.parent;
    message.child_frame_id = frame.child;
    message.transform.translation = to_vector3(frame.child_in_parent.translation());
    message.transform.rotation = to_message(Eigen::Quaterniond(frame.child_in_parent.linear()));
    messages.push_back(message);
  }
  return messages;
}

void publish_frames() {
  ros::NodeHandle node;
  const FrameTree tree(node.param<std::string>("robot_description", ""));
  tf2_ros::StaticTransformBroadcaster fixed;
  tf2_ros::TransformBroadcaster moving;
  fixed.sendTransform(to_messages(tree.fixed(), ros::Time(0)));
  const ros::Subscriber joints = node.subscribe<sensor_msgs::JointState>(
      prf_msgs::topics::kJointStates, kQueue,
      [&](const sensor_msgs::JointStateConstPtr& message) {
        moving.sendTransform(
            to_messages(tree.moving(message->name, message->position), message->header.stamp));
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  ros::spin();
}

}  // namespace
}  // namespace prf_ros

int main(int argc, char** argv) {
  ros::init(argc, argv, "robot_state_publisher");
  return prf_ros::run(prf_ros::publish_frames);
}
