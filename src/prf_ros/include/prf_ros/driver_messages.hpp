// SPDX-License-Identifier: BSD-3-Clause
// Messages of arm drivers that Debian does not have, for use where their packages are not
// installed: roscpp sends and receives these structs under the drivers' own type names and
// checksums, so that they talk to a driver that was built with the real packages.
// test_driver_messages.cpp compares them with code generated from the definitions of kinova_msgs
// (kinova-ros) and kortex_driver (ros_kortex).
//
//   kinova::JointVelocity   kinova_msgs/JointVelocity, deg/s
//   kinova::Stop, Start     services kinova_msgs/Stop and kinova_msgs/Start
//   kortex::BaseJointSpeeds kortex_driver/Base_JointSpeeds, rad/s
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace prf_ros {
namespace kinova {

struct JointVelocity {
  std::array<float, 7> joints{};  // deg/s, joint1 to joint7
};

struct StopRequest {};
struct StopResponse {
  std::string stop_result;
};
struct StartRequest {};
struct StartResponse {
  std::string start_result;
};

}  // namespace kinova

namespace kortex {

struct JointSpeed {
  std::uint32_t joint_identifier = 0;  // from 0
  float value = 0.0F;                  // rad/s
  std::uint32_t duration = 0;          // 0: until the next one
};

struct BaseJointSpeeds {
  std::vector<JointSpeed> joint_speeds;
  std::uint32_t duration = 0;
};

}  // namespace kortex
}  // namespace prf_ros

// What roscpp asks of a message type. The checksum is that of the definition, comments aside.
#define PRF_ROS_MESSAGE(TYPE, NAME, CHECKSUM, DEFINITION)     \
  namespace ros::message_traits {                             \
  template <>                                                 \
  struct IsMessage<TYPE> : TrueType {};                       \
  template <>                                                 \
  struct MD5Sum<TYPE> {                                       \
    static const char* value() { return CHECKSUM; }           \
    static const char* value(const TYPE&) { return value(); } \
  };                                                          \
  template <>                                                 \
  struct DataType<TYPE> {                                     \
    static const char* value() { return NAME; }               \
    static const char* value(const TYPE&) { return value(); } \
  };                                                          \
  template <>                                                 \
  struct Definition<TYPE> {                                   \
    static const char* value() { return DEFINITION; }         \
    static const char* value(const TYPE&) { return value(); } \
  };                                                          \
  }

// The same for one side of a service. The checksum is that of request and response together.
#define PRF_ROS_SERVICE_SIDE(TYPE, NAME, CHECKSUM)            \
  namespace ros::service_traits {                             \
  template <>                                                 \
  struct MD5Sum<TYPE> {                                       \
    static const char* value() { return CHECKSUM; }           \
    static const char* value(const TYPE&) { return value(); } \
  };                                                          \
  template <>                                                 \
  struct DataType<TYPE> {                                     \
    static const char* value() { return NAME; }               \
    static const char* value(const TYPE&) { return value(); } \
  };                                                          \
  }

PRF_ROS_MESSAGE(prf_ros::kinova::JointVelocity, "kinova_msgs/JointVelocity",
                "bf16c4e5154848a0767d1aaab0a4796b",
                "float32 joint1\nfloat32 joint2\nfloat32 joint3\nfloat32 joint4\nfloat32 joint5\n"
                "float32 joint6\nfloat32 joint7\n")
PRF_ROS_MESSAGE(prf_ros::kortex::JointSpeed, "kortex_driver/JointSpeed",
                "fd26fce9b45cd51d86512ba0cf80d2bd",
                "uint32 joint_identifier\nfloat32 value\nuint32 duration\n")
PRF_ROS_MESSAGE(prf_ros::kortex::BaseJointSpeeds, "kortex_driver/Base_JointSpeeds",
                "f323c64d027d947f420c021696580eb4",
                "JointSpeed[] joint_speeds\nuint32 duration\n\n"
                "================================================================================\n"
                "MSG: kortex_driver/JointSpeed\n"
                "uint32 joint_identifier\nfloat32 value\nuint32 duration\n")
PRF_ROS_MESSAGE(prf_ros::kinova::StopRequest, "kinova_msgs/StopRequest",
                "d41d8cd98f00b204e9800998ecf8427e", "")
PRF_ROS_MESSAGE(prf_ros::kinova::StopResponse, "kinova_msgs/StopResponse",
                "585dc4164508d473dff8f8b67a05d2ad", "string stop_result\n")
PRF_ROS_MESSAGE(prf_ros::kinova::StartRequest, "kinova_msgs/StartRequest",
                "d41d8cd98f00b204e9800998ecf8427e", "")
PRF_ROS_MESSAGE(prf_ros::kinova::StartResponse, "kinova_msgs/StartResponse",
                "e762e31d813526eaaa6a12e8354174fc", "string start_result\n")
PRF_ROS_SERVICE_SIDE(prf_ros::kinova::StopRequest, "kinova_msgs/Stop",
                     "585dc4164508d473dff8f8b67a05d2ad")
PRF_ROS_SERVICE_SIDE(prf_ros::kinova::StopResponse, "kinova_msgs/Stop",
                     "585dc4164508d473dff8f8b67a05d2ad")
PRF_ROS_SERVICE_SIDE(prf_ros::kinova::StartRequest, "kinova_msgs/Start",
                     "e762e31d813526eaaa6a12e8354174fc")
PRF_ROS_SERVICE_SIDE(prf_ros::kinova::StartResponse, "kinova_msgs/Start",
                     "e762e31d813526eaaa6a12e8354174fc")

#undef PRF_ROS_MESSAGE
#undef PRF_ROS_SERVICE_SIDE

namespace ros::serialization {

template <>
struct Serializer<prf_ros::kinova::JointVelocity> {
  template <typename Stream, typename T>
  static void allInOne(Stream& stream, T message) {
    for (auto& joint : message.joints) stream.next(joint);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<prf_ros::kortex::JointSpeed> {
  template <typename Stream, typename T>
  static void allInOne(Stream& stream, T message) {
    stream.next(message.joint_identifier);
    stream.next(message.value);
    stream.next(message.duration);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<prf_ros::kortex::BaseJointSpeeds> {
  template <typename Stream, typename T>
  static void allInOne(Stream& stream, T message) {
    stream.next(message.joint_speeds);
    stream.next(message.duration);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<prf_ros::kinova::StopRequest> {
  template <typename Stream, typename T>
  static void allInOne(Stream&, T) {}
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<prf_ros::kinova::StartRequest> {
  template <typename Stream, typename T>
  static void allInOne(Stream&, T) {}
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<prf_ros::kinova::StopResponse> {
  template <typename Stream, typename T>
  static void allInOne(Stream& stream, T message) {
    stream.next(message.stop_result);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<prf_ros::kinova::StartResponse> {
  template <typename Stream, typename T>
  static void allInOne(Stream& stream, T message) {
    stream.next(message.start_result);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace ros::serialization
