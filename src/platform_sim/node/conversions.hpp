// SPDX-License-Identifier: BSD-3-Clause
// Core types to messages and back.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/Odometry.h>
#include <prf_msgs/ContactArray.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/image_encodings.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <algorithm>
#include <opencv2/core/mat.hpp>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <prf_ros/conversions.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "camera_sim/camera_renderer.hpp"
#include "platform_sim/world.hpp"

namespace platform_sim {

inline ros::Time to_stamp(std::int64_t milliseconds) {
  return ros::Time(static_cast<std::uint32_t>(milliseconds / 1000),
                   static_cast<std::uint32_t>(milliseconds % 1000 * 1'000'000));
}

inline geometry_msgs::Pose to_pose(const Eigen::Isometry3d& pose) {
  return prf_ros::to_message(prf_core::Pose{pose.translation(), Eigen::Quaterniond(pose.linear())});
}

inline geometry_msgs::PoseStamped to_pose_stamped(const std_msgs::Header& header,
                                                  const Eigen::Isometry3d& pose) {
  geometry_msgs::PoseStamped message;
  message.header = header;
  message.pose = to_pose(pose);
  return message;
}

// nav_msgs: the pose is in header.frame_id, the twist in child_frame_id.
inline nav_msgs::Odometry to_odometry(const std_msgs::Header& header, const std::string& child,
                                      const FrameState& state) {
  nav_msgs::Odometry message;
  message.header = header;
  message.child_frame_id = child;
  message.pose.pose = to_pose(state.pose);
  const Eigen::Matrix3d world_to_child = state.pose.linear().transpose();
  message.twist.twist.linear = prf_ros::to_vector3(world_to_child * state.linear);
  message.twist.twist.angular = prf_ros::to_vector3(world_to_child * state.angular);
  return message;
}

inline prf_msgs::ContactArray to_contact_array(const std_msgs::Header& header,
                                               const std::vector<Contact>& contacts) {
  prf_msgs::ContactArray message;
  message.header = header;
  for (const Contact& contact : contacts) {
    prf_msgs::Contact& entry = message.contacts.emplace_back();
    entry.link_a = contact.link_a;
    entry.link_b = contact.link_b;
    entry.force = contact.force;
    entry.position = prf_ros::to_point(contact.position);
  }
  return message;
}

inline sensor_msgs::JointState to_joint_state(const ros::Time& stamp,
                                              const std::vector<std::string>& names,
                                              const JointStates& joints) {
  const auto to_vector = [](const Eigen::VectorXd& values) {
    return std::vector<double>(values.begin(), values.end());
  };
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = names;
  message.position = to_vector(joints.positions);
  message.velocity = to_vector(joints.velocities);
  message.effort = to_vector(joints.efforts);
  return message;
}

inline sensor_msgs::Image to_image(const std_msgs::Header& header, const cv::Mat& mono8) {
  sensor_msgs::Image message;
  message.header = header;
  message.height = static_cast<std::uint32_t>(mono8.rows);
  message.width = static_cast<std::uint32_t>(mono8.cols);
  message.step = message.width;
  message.encoding = sensor_msgs::image_encodings::MONO8;
  message.data.assign(mono8.datastart, mono8.dataend);
  return message;
}

inline sensor_msgs::CameraInfo to_camera_info(const camera_sim::PinholeCamera& camera) {
  sensor_msgs::CameraInfo message;
  message.height = static_cast<std::uint32_t>(camera.height);
  message.width = static_cast<std::uint32_t>(camera.width);
  message.distortion_model = "plumb_bob";
  message.D.assign(camera.distortion.begin(), camera.distortion.end());
  message.K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  message.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  message.P = {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return message;
}

// Far beyond what an arm, or a hand that guides it, can do.
constexpr double kLargestPosition = 100.0;  // rad; a joint without limits may have turned often
constexpr double kLargestVelocity = 20.0;   // rad/s
constexpr double kLargestForce = 1000.0;    // N
constexpr double kLargestTorque = 1000.0;   // Nm

struct ArmCommand {
  ArmVector positions;   // rad
  ArmVector velocities;  // rad/s
};

// Throws std::invalid_argument that says why the command is refused.
inline ArmCommand to_arm_command(const trajectory_msgs::JointTrajectory& message,
                                 const std::vector<std::string>& joints) {
  const std::string wanted = std::to_string(joints.size());
  if (message.joint_names.size() != joints.size()) {
    throw std::invalid_argument(std::to_string(message.joint_names.size()) +
                                " joint names, must be " + wanted);
  }
  if (message.points.size() != 1 || message.points[0].positions.size() != joints.size() ||
      message.points[0].velocities.size() != joints.size()) {
    const std::size_t points = message.points.size();
    const std::string found =
        points != 1 ? std::to_string(points) + " points"
                    : std::to_string(message.points[0].positions.size()) + " positions and " +
                          std::to_string(message.points[0].velocities.size()) + " velocities";
    throw std::invalid_argument(found + ", must be one point of " + wanted + " positions and " +
                                wanted + " velocities");
  }
  const auto count = static_cast<Eigen::Index>(joints.size());
  ArmCommand command{ArmVector::Zero(count), ArmVector::Zero(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::string& name = joints[static_cast<std::size_t>(i)];
    const auto found = std::find(message.joint_names.begin(), message.joint_names.end(), name);
    if (found == message.joint_names.end()) {
      throw std::invalid_argument(name + " is not among joint_names, all " + wanted + " must be");
    }
    const auto index = static_cast<std::size_t>(found - message.joint_names.begin());
    command.positions[i] = message.points[0].positions[index];
    command.velocities[i] = message.points[0].velocities[index];
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::string joint = " of joint " + std::to_string(i + 1);
    prf_core::require_between("position" + joint, command.positions[i], -kLargestPosition,
                              kLargestPosition, "rad");
    prf_core::require_between("velocity" + joint, command.velocities[i], -kLargestVelocity,
                              kLargestVelocity, "rad/s");
  }
  return command;
}

struct HandWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N, in world
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  // Nm, in world
};

// Throws std::invalid_argument that says why the wrench is refused.
inline HandWrench to_hand_wrench(const geometry_msgs::WrenchStamped& message) {
  if (message.header.frame_id != "world") {
    throw std::invalid_argument("frame_id = " + prf_core::quoted(message.header.frame_id) +
                                ", must be world");
  }
  const HandWrench wrench{prf_ros::to_core(message.wrench.force),
                          prf_ros::to_core(message.wrench.torque)};
  for (int i = 0; i < 3; ++i) {
    prf_core::require_between("force", wrench.force[i], -kLargestForce, kLargestForce, "N");
    prf_core::require_between("torque", wrench.torque[i], -kLargestTorque, kLargestTorque, "Nm");
  }
  return wrench;
}

}  // namespace platform_sim
