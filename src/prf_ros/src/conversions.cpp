// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/conversions.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/bounds.hpp>
#include <prf_core/require.hpp>

namespace prf_ros {

prf_core::Stamp to_core(const ros::Time& stamp) {
  return std::chrono::seconds(stamp.sec) + std::chrono::nanoseconds(stamp.nsec);
}

prf_core::Duration to_core(const ros::Duration& duration) {
  return std::chrono::seconds(duration.sec) + std::chrono::nanoseconds(duration.nsec);
}

Eigen::Vector3d to_core(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

Eigen::Vector3d to_core(const geometry_msgs::Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}

Eigen::Quaterniond to_core(const geometry_msgs::Quaternion& quaternion) {
  return {quaternion.w, quaternion.x, quaternion.y, quaternion.z};
}

prf_core::Pose to_core(const geometry_msgs::Pose& pose) {
  prf_core::Pose result{to_core(pose.position), to_core(pose.orientation)};
  if (std::abs(result.orientation.norm() - 1.0) <= prf_core::kUnitQuaternionTolerance) {
    result.orientation.normalize();
  }
  return result;
}

std::optional<prf_core::Stamp> usable_stamp(const ros::Time& stamp) {
  const prf_core::Stamp result = to_core(stamp);
  if (!prf_core::is_usable_stamp(result)) return std::nullopt;
  return result;
}

prf_core::Stamp checked_stamp(const std::string& name, const ros::Time& stamp) {
  const prf_core::Stamp result = to_core(stamp);
  prf_core::require_stamp(name, result);
  return result;
}

ros::Time to_ros_time(prf_core::Stamp stamp) {
  const prf_core::Stamp least{0};
  const prf_core::Stamp most = to_core(ros::TIME_MAX);
  const auto held = std::clamp(stamp, least, most).count();
  return ros::Time().fromNSec(static_cast<std::uint64_t>(held));
}

ros::Duration to_ros_duration(prf_core::Duration duration) {
  const prf_core::Duration least = to_core(ros::DURATION_MIN);
  const prf_core::Duration most = to_core(ros::DURATION_MAX);
  return ros::Duration().fromNSec(std::clamp(duration, least, most).count());
}

geometry_msgs::Point to_point(const Eigen::Vector3d& vector) {
  geometry_msgs::Point message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Vector3 to_vector3(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Quaternion to_message(const Eigen::Quaterniond& quaternion) {
  geometry_msgs::Quaternion message;
  message.x = quaternion.x();
  message.y = quaternion.y();
  message.z = quaternion.z();
  message.w = quaternion.w();
  return message;
}

geometry_msgs::Pose to_message(const prf_core::Pose& pose) {
  geometry_msgs::Pose message;
  message.position = to_point(pose.position);
  message.orientation = to_message(pose.orientation);
  return message;
}

geometry_msgs::Twist to_twist(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  geometry_msgs::Twist message;
  message.linear = to_vector3(linear);
  message.angular = to_vector3(angular);
  return message;
}

prf_core::TargetStatus to_target_status(std::uint8_t status) {
  using prf_core::TargetStatus;
  using prf_msgs::TargetForecast;
  switch (status) {
    case TargetForecast::NO_TARGET:
      return TargetStatus::kNoTarget;
    case TargetForecast::TRACKING:
      return TargetStatus::kTracking;
    case TargetForecast::COASTING:
      return TargetStatus::kCoasting;
    case TargetForecast::LOST:
      return TargetStatus::kLost;
    default:
      prf_core::require(false, "status", int{status}, "0 .. 3");
      return TargetStatus::kNoTarget;
  }
}

std::uint8_t to_message(prf_core::TargetStatus status) {
  using prf_core::TargetStatus;
  using prf_msgs::TargetForecast;
  switch (status) {
    case TargetStatus::kNoTarget:
      return TargetForecast::NO_TARGET;
    case TargetStatus::kTracking:
      return TargetForecast::TRACKING;
    case TargetStatus::kCoasting:
      return TargetForecast::COASTING;
    case TargetStatus::kLost:
      break;
  }
  return TargetForecast::LOST;
}

prf_core::TargetForecast to_core(const prf_msgs::TargetForecast& message) {
  prf_core::TargetForecast forecast;
  forecast.stamp = checked_stamp("header.stamp", message.header.stamp);
  forecast.status = to_target_status(message.status);
  forecast.since_measurement = to_core(message.since_measurement);
  for (const auto& prediction : message.predictions) {
    using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    forecast.predictions.push_back({to_core(prediction.horizon),
                                    {to_core(prediction.pose), to_core(prediction.twist.linear),
                                     to_core(prediction.twist.angular)},
                                    Eigen::Map<const RowMajor6d>(prediction.covariance.data())});
  }
  using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  forecast.measured_motion = {
      to_core(message.measured_velocity),
      Eigen::Map<const RowMajor3d>(message.measured_velocity_covariance.data()),
      message.measured_speed};
  forecast.validate();
  return forecast;
}

}  // namespace prf_ros
