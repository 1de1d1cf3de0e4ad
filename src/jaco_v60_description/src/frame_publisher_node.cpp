// SPDX-License-Identifier: BSD-3-Clause
// tf of the robot, one message for every joint_states.
//
// Stands in for robot_state_publisher, which keeps only the newest of the joint_states that wait
// for it and stamps fixed frames with the time of day: with it, what the framework sees would
// depend on the load of the machine.
#include <geometry_msgs/TransformStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "frame_tree.hpp"

namespace {

using jaco_v60_description::FrameTree;
using jaco_v60_description::LinkFrame;

constexpr unsigned kQueue = 1000;

std::vector<geometry_msgs::TransformStamped> to_messages(const std::vector<LinkFrame>& frames,
                                                         const ros::Time& stamp) {
  std::vector<geometry_msgs::TransformStamped> messages;
  for (const LinkFrame& frame : frames) {
    geometry_msgs::TransformStamped message;
    message.header.stamp = stamp;
    message.header.frame_id = frame.parent;
    message.child_frame_id = frame.child;
    const Eigen::Vector3d position = frame.child_in_parent.translation();
    const Eigen::Quaterniond rotation(frame.child_in_parent.linear());
    message.transform.translation.x = position.x();
    message.transform.translation.y = position.y();
    message.transform.translation.z = position.z();
    message.transform.rotation.x = rotation.x();
    message.transform.rotation.y = rotation.y();
    message.transform.rotation.z = rotation.z();
    message.transform.rotation.w = rotation.w();
    messages.push_back(message);
  }
  return messages;
}

void publish_frames(const FrameTree& tree) {
  ros::NodeHandle node;
  tf2_ros::StaticTransformBroadcaster fixed;
  tf2_ros::TransformBroadcaster moving;
  fixed.sendTransform(to_messages(tree.fixed(), ros::Time(0)));
  const ros::Subscriber joints = node.subscribe<sensor_msgs::JointState>(
      "joint_states", kQueue,
      [&](const sensor_msgs::JointStateConstPtr& message) {
        moving.sendTransform(
            to_messages(tree.moving(message->name, message->position), message->header.stamp));
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  ros::spin();
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "robot_state_publisher");
  try {
    const std::string urdf = ros::NodeHandle().param<std::string>("robot_description", "");
    publish_frames(FrameTree(urdf));
  } catch (const std::invalid_argument& error) {
    ROS_FATAL("%s", error.what());
    return 2;
  }
  return 0;
}
