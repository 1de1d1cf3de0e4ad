// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/driver_messages.hpp"

#include <gtest/gtest.h>
// Generated from test/messages/, which has the fields of the drivers' own definitions.
#include "kinova_msgs/JointVelocity.h"
#include "kinova_msgs/Start.h"
#include "kinova_msgs/Stop.h"
#include "kortex_driver/Base_JointSpeeds.h"

#include <string>
#include <vector>

namespace {

namespace traits = ros::message_traits;
using prf_ros::kinova::JointVelocity;
using prf_ros::kortex::BaseJointSpeeds;

template <typename Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <typename Message>
Message read_from(std::vector<std::uint8_t> bytes) {
  Message message;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
  return message;
}

template <typename Ours, typename Generated>
void expect_same_type() {
  EXPECT_STREQ(traits::datatype<Ours>(), traits::datatype<Generated>());
  EXPECT_STREQ(traits::md5sum<Ours>(), traits::md5sum<Generated>());
}

TEST(DriverMessages, HaveTheNamesAndChecksumsOfTheDriversTypes) {
  expect_same_type<JointVelocity, kinova_msgs::JointVelocity>();
  expect_same_type<prf_ros::kinova::StopRequest, kinova_msgs::StopRequest>();
  expect_same_type<prf_ros::kinova::StopResponse, kinova_msgs::StopResponse>();
  expect_same_type<prf_ros::kinova::StartRequest, kinova_msgs::StartRequest>();
  expect_same_type<prf_ros::kinova::StartResponse, kinova_msgs::StartResponse>();
  expect_same_type<prf_ros::kortex::JointSpeed, kortex_driver::JointSpeed>();
  expect_same_type<BaseJointSpeeds, kortex_driver::Base_JointSpeeds>();
  namespace services = ros::service_traits;
  EXPECT_STREQ(services::md5sum<prf_ros::kinova::StopRequest>(),
               services::md5sum<kinova_msgs::Stop>());
  EXPECT_STREQ(services::md5sum<prf_ros::kinova::StartResponse>(),
               services::md5sum<kinova_msgs::Start>());
  EXPECT_STREQ(services::datatype<prf_ros::kinova::StopRequest>(),
               services::datatype<kinova_msgs::Stop>());
}

TEST(DriverMessages, KinovaReadsTheVelocitiesThatWereSent) {
  const JointVelocity sent{{1.5F, -2.0F, 3.0F, 4.0F, 5.0F, 6.0F, -7.25F}};
  const auto read = read_from<kinova_msgs::JointVelocity>(bytes_of(sent));
  EXPECT_EQ(read.joint1, 1.5F);
  EXPECT_EQ(read.joint2, -2.0F);
  EXPECT_EQ(read.joint7, -7.25F);
  EXPECT_EQ(read_from<JointVelocity>(bytes_of(read)).joints, sent.joints);
}

TEST(DriverMessages, KortexReadsTheSpeedsThatWereSent) {
  const BaseJointSpeeds sent{{{0, 0.25F, 0}, {1, -0.5F, 0}}, 0};
  const auto read = read_from<kortex_driver::Base_JointSpeeds>(bytes_of(sent));
  ASSERT_EQ(read.joint_speeds.size(), 2U);
  EXPECT_EQ(read.joint_speeds[1].joint_identifier, 1U);
  EXPECT_EQ(read.joint_speeds[1].value, -0.5F);
  EXPECT_EQ(bytes_of(sent), bytes_of(read));
}

TEST(DriverMessages, TheStopServiceIsRead) {
  const auto read = read_from<kinova_msgs::StopResponse>(
      bytes_of(prf_ros::kinova::StopResponse{"JACO ARM HAS BEEN STOPPED"}));
  EXPECT_EQ(read.stop_result, "JACO ARM HAS BEEN STOPPED");
  EXPECT_TRUE(bytes_of(prf_ros::kinova::StopRequest{}).empty());
}

}  // namespace
