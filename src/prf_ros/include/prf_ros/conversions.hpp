// SPDX-License-Identifier: BSD-3-Clause
// Converts messages to the types of prf_core and back. Frames are not checked: header.frame_id is
// the node's business.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Vector3.h>
#include <prf_msgs/TargetForecast.h>
#include <ros/duration.h>
#include <ros/time.h>

#include <optional>
#include <prf_core/forecast.hpp>
#include <prf_core/se3.hpp>
#include <prf_core/time.hpp>
#include <string>

namespace prf_ros {

[[nodiscard]] prf_core::Stamp to_core(const ros::Time& stamp);
[[nodiscard]] prf_core::Duration to_core(const ros::Duration& duration);
[[nodiscard]] Eigen::Vector3d to_core(const geometry_msgs::Point& point);
[[nodiscard]] Eigen::Vector3d to_core(const geometry_msgs::Vector3& vector);
[[nodiscard]] Eigen::Quaterniond to_core(const geometry_msgs::Quaternion& quaternion);
// A quaternion whose norm is within prf_core::kUnitQuaternionTolerance of 1 is normalised. Any
// other is left as it is; prf_core::require_pose(), which each validate() calls, refuses it.
[[nodiscard]] prf_core::Pose to_core(const geometry_msgs::Pose& pose);

// For stamps of foreign messages, once, where they become values: a stamp beyond the bounds of
// prf_core/bounds.hpp is refused, the second time with std::invalid_argument that names it. With
// the stamps that pass, an hour added or taken away can be used without a check.
[[nodiscard]] std::optional<prf_core::Stamp> usable_stamp(const ros::Time& stamp);
[[nodiscard]] prf_core::Stamp checked_stamp(const std::string& name, const ros::Time& stamp);

// Never throw: what ROS cannot hold (a stamp below 0 or beyond the year 2106, a duration beyond 68
// years) becomes the nearest value that it can.
[[nodiscard]] ros::Time to_ros_time(prf_core::Stamp stamp);
[[nodiscard]] ros::Duration to_ros_duration(prf_core::Duration duration);
[[nodiscard]] geometry_msgs::Point to_point(const Eigen::Vector3d& vector);
[[nodiscard]] geometry_msgs::Vector3 to_vector3(const Eigen::Vector3d& vector);
[[nodiscard]] geometry_msgs::Quaternion to_message(const Eigen::Quaterniond& quaternion);
[[nodiscard]] geometry_msgs::Pose to_message(const prf_core::Pose& pose);
[[nodiscard]] geometry_msgs::Twist to_twist(const Eigen::Vector3d& linear,
                                            const Eigen::Vector3d& angular);

// Throws std::invalid_argument for a status that the message does not define, and whatever
// TargetForecast::validate() refuses.
[[nodiscard]] prf_core::TargetForecast to_core(const prf_msgs::TargetForecast& message);
[[nodiscard]] prf_core::TargetStatus to_target_status(std::uint8_t status);
[[nodiscard]] std::uint8_t to_message(prf_core::TargetStatus status);

}  // namespace prf_ros
