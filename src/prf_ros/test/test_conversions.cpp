// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/conversions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace prf_ros {
namespace {

using prf_core::TargetStatus;

geometry_msgs::Quaternion quaternion(double x, double y, double z, double w) {
  return to_message(Eigen::Quaterniond(w, x, y, z));
}

TEST(Conversions, KeepEveryNanosecond) {
  for (const ros::Time& time : {ros::Time(0, 0), ros::Time(0, 1), ros::Time(12, 999'999'999),
                                ros::Time(1'700'000'000, 123'456'789)}) {
    EXPECT_EQ(to_ros_time(to_core(time)), time);
  }
  EXPECT_EQ(to_core(ros::Time(3, 7)), prf_core::Stamp{3'000'000'007});
  for (const ros::Duration& duration :
       {ros::Duration(0, 0), ros::Duration(2, 5), ros::Duration(-1, 999'999'999)}) {
    EXPECT_EQ(to_ros_duration(to_core(duration)), duration);
  }
  EXPECT_EQ(to_core(ros::Duration(-1, 999'999'999)), prf_core::Duration{-1});
}

// Fault 42: stamps and sums at the ends of ROS time -> refused or held there, never a throw
TEST(Conversions, HoldStampsToTheEndsOfRosTime) {
  using prf_core::Stamp;
  EXPECT_EQ(to_ros_time(Stamp{-1}), ros::Time(0, 0));
  EXPECT_EQ(to_ros_time(Stamp::min()), ros::Time(0, 0));
  EXPECT_EQ(to_ros_time(Stamp::max()), ros::TIME_MAX);
  EXPECT_EQ(to_ros_time(to_core(ros::TIME_MAX) + std::chrono::hours(1)), ros::TIME_MAX);
  EXPECT_EQ(to_ros_duration(prf_core::Duration::max()), ros::DURATION_MAX);
  EXPECT_EQ(to_ros_duration(prf_core::Duration::min()), ros::DURATION_MIN);
  for (const ros::Time& stamp : {ros::TIME_MAX, ros::Time(4294963696, 0)}) {
    EXPECT_FALSE(usable_stamp(stamp));
    EXPECT_THROW((void)checked_stamp("stamp", stamp), std::invalid_argument);
  }
  for (const ros::Time& stamp : {ros::Time(0, 0), ros::Time(4294963695, 0)}) {
    EXPECT_EQ(to_ros_time(*usable_stamp(stamp)), stamp);
    EXPECT_EQ(to_ros_time(checked_stamp("stamp", stamp)), stamp);
  }
}

TEST(Conversions, KeepEveryComponent) {
  const Eigen::Vector3d vector(0.1, -2.0, 3e-7);
  EXPECT_EQ(to_core(to_point(vector)), vector);
  EXPECT_EQ(to_core(to_vector3(vector)), vector);
  const geometry_msgs::Quaternion message = quaternion(0.1, 0.2, 0.3, 0.4);
  EXPECT_EQ(message.x, 0.1);
  EXPECT_EQ(message.y, 0.2);
  EXPECT_EQ(message.z, 0.3);
  EXPECT_EQ(message.w, 0.4);
  EXPECT_EQ(to_core(message).coeffs(), Eigen::Vector4d(0.1, 0.2, 0.3, 0.4));
  const geometry_msgs::Twist twist = to_twist(vector, 2 * vector);
  EXPECT_EQ(to_core(twist.linear), vector);
  EXPECT_EQ(to_core(twist.angular), 2 * vector);
}

// Fault 2: a quaternion that is not unit -> normalised within 0.001, else refused
TEST(Conversions, NormaliseAQuaternionOnlyNearTheUnit) {
  geometry_msgs::Pose message;
  message.orientation = quaternion(0.0, 0.0, 0.6 * 1.0009, 0.8 * 1.0009);
  EXPECT_NEAR(to_core(message).orientation.norm(), 1.0, 1e-15);
  EXPECT_NEAR(to_core(message).orientation.z(), 0.6, 1e-15);
  for (const double norm : {0.0, 0.9, 1.002}) {
    message.orientation = quaternion(0.0, 0.0, 0.6 * norm, 0.8 * norm);
    EXPECT_EQ(to_core(message).orientation.z(), 0.6 * norm) << norm;
    EXPECT_THROW(prf_core::require_pose("pose", to_core(message)), std::invalid_argument);
  }
  const prf_core::Pose pose{{1, 2, 3}, Eigen::Quaterniond(0.6, 0, 0.8, 0)};
  const prf_core::Pose back = to_core(to_message(pose));
  EXPECT_EQ(back.position, pose.position);
  EXPECT_TRUE(back.orientation.isApprox(pose.orientation, 1e-15));
}

TEST(Conversions, MapEveryStatusOfTheForecast) {
  using prf_msgs::TargetForecast;
  const std::pair<TargetStatus, std::uint8_t> all[] = {
      {TargetStatus::kNoTarget, TargetForecast::NO_TARGET},
      {TargetStatus::kTracking, TargetForecast::TRACKING},
      {TargetStatus::kCoasting, TargetForecast::COASTING},
      {TargetStatus::kLost, TargetForecast::LOST}};
  for (const auto& [status, code] : all) {
    EXPECT_EQ(to_message(status), code);
    EXPECT_EQ(to_target_status(code), status);
  }
  EXPECT_THROW((void)to_target_status(4), std::invalid_argument);
}

prf_msgs::TargetForecast forecast() {
  prf_msgs::TargetForecast message;
  message.header.stamp = ros::Time(10, 5);
  message.status = prf_msgs::TargetForecast::COASTING;
  message.since_measurement = ros::Duration(0.25);
  for (const double horizon : {0.0, 0.5}) {
    prf_msgs::TargetPrediction prediction;
    prediction.horizon = ros::Duration(horizon);
    prediction.pose.position.x = 1.0 + horizon;
    prediction.pose.orientation.w = 1.0;
    prediction.twist.linear.y = 0.1;
    prediction.twist.angular.z = 0.2;
    for (std::size_t i = 0; i < 36; ++i) prediction.covariance[i] = static_cast<double>(i);
    message.predictions.push_back(prediction);
  }
  return message;
}

TEST(Conversions, ReadAForecast) {
  const prf_core::TargetForecast read = to_core(forecast());
  EXPECT_EQ(read.stamp, prf_core::Stamp{10'000'000'005});
  EXPECT_EQ(read.status, TargetStatus::kCoasting);
  EXPECT_EQ(read.since_measurement, prf_core::Duration{250'000'000});
  ASSERT_EQ(read.predictions.size(), 2u);
  const prf_core::TargetPrediction& last = read.predictions[1];
  EXPECT_EQ(last.horizon, prf_core::Duration{500'000'000});
  EXPECT_EQ(last.target.pose.position, Eigen::Vector3d(1.5, 0, 0));
  EXPECT_EQ(last.target.linear_velocity, Eigen::Vector3d(0, 0.1, 0));
  EXPECT_EQ(last.target.angular_velocity, Eigen::Vector3d(0, 0, 0.2));
  EXPECT_EQ(last.covariance(0, 1), 1.0);  // row by row
  EXPECT_EQ(last.covariance(1, 0), 6.0);
}

// Fault 1: a forecast with NaN, no prediction or an unknown status -> refused
TEST(Conversions, RefuseABrokenForecast) {
  prf_msgs::TargetForecast message = forecast();
  message.status = 9;
  EXPECT_THROW((void)to_core(message), std::invalid_argument);
  message = forecast();
  message.predictions[1].pose.position.x = std::nan("");
  EXPECT_THROW((void)to_core(message), std::invalid_argument);
  message = forecast();
  message.predictions.clear();
  EXPECT_THROW((void)to_core(message), std::invalid_argument);
}

}  // namespace
}  // namespace prf_ros
