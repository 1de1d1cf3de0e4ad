// SPDX-License-Identifier: BSD-3-Clause
// Frames of the built model: tf agrees with KDL, message by message.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/transform_listener.h>

#include <string>
#include <vector>

#include "hand_of_urdf.hpp"

namespace jaco_v60_description {
namespace {

constexpr double kWait = 15.0;  // [s], for processes to start and messages to arrive

sensor_msgs::JointState joint_states(const std::vector<double>& q, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = arm_joints();
  message.position = q;
  for (const char* leg : {"fl", "fr", "rl", "rr"}) {
    for (const char* joint : {"_abduction", "_hip", "_knee"}) {
      message.name.push_back(std::string(leg) + joint);
      message.position.push_back(0.5);
    }
  }
  return message;
}

class Description : public testing::Test {
 protected:
  Description() : listener_(buffer_) {
    publisher_ = node_.advertise<sensor_msgs::JointState>("joint_states", 100);
  }

  // Publishes until a joint state has come back as a frame.
  bool connect() {
    const ros::WallTime limit = ros::WallTime::now() + ros::WallDuration(kWait);
    while (ros::WallTime::now() < limit) {
      connected_at_ = ros::Time::now();
      publisher_.publish(joint_states(ready_, connected_at_));
      if (buffer_.canTransform("j2s7s300_link_base", "j2s7s300_end_effector", connected_at_,
                               ros::Duration(0.2))) {
        return true;
      }
    }
    return false;
  }

  void expect_hand(const std::vector<double>& q, const ros::Time& stamp) const {
    const auto hand =
        buffer_.lookupTransform("j2s7s300_link_base", "j2s7s300_end_effector", stamp).transform;
    const Eigen::Vector3d expected = hand_of_urdf(q).translation();
    ASSERT_NEAR(hand.translation.x, expected.x(), 1e-9);
    ASSERT_NEAR(hand.translation.y, expected.y(), 1e-9);
    ASSERT_NEAR(hand.translation.z, expected.z(), 1e-9);
  }

  const std::vector<double> ready_ = std::vector<double>(7, 2.0);
  ros::Time connected_at_;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

// Publishers need a moment to meet their subscribers; a message before that reaches nobody.
TEST_F(Description, PublishesTheHandOnceConnected) {
  ASSERT_TRUE(connect());
  expect_hand(ready_, connected_at_);
}

TEST_F(Description, PublishesTheHandOfEveryJointState) {
  ASSERT_TRUE(connect());
  std::vector<double> q = ready_;
  for (int tick = 1; tick <= 50; ++tick) {
    const ros::Time stamp = connected_at_ + ros::Duration(0.01 * tick);
    q[0] += 0.02;
    publisher_.publish(joint_states(q, stamp));
    ASSERT_TRUE(buffer_.canTransform("j2s7s300_link_base", "j2s7s300_end_effector", stamp,
                                     ros::Duration(kWait)))
        << "tick " << tick;
    ASSERT_NO_FATAL_FAILURE(expect_hand(q, stamp));
  }
}

TEST_F(Description, HasTheFixedFramesWithoutJointStates) {
  EXPECT_TRUE(
      buffer_.canTransform("base_link", "j2s7s300_link_base", ros::Time(0), ros::Duration(kWait)));
  EXPECT_TRUE(buffer_.canTransform("j2s7s300_end_effector", "camera_optical_frame", ros::Time(0),
                                   ros::Duration(kWait)));
}

}  // namespace
}  // namespace jaco_v60_description

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "description_test");
  return RUN_ALL_TESTS();
}
