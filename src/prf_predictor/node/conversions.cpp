// SPDX-License-Identifier: BSD-3-Clause
#include "conversions.hpp"

#include <algorithm>
#include <prf_ros/conversions.hpp>

namespace prf_predictor {
namespace {

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

constexpr double kLongestAge = 1e8;  // s, that a message can hold

prf_msgs::TargetPrediction to_message(const prf_core::TargetPrediction& prediction) {
  prf_msgs::TargetPrediction message;
  message.horizon = prf_ros::to_ros_duration(prediction.horizon);
  message.pose = prf_ros::to_message(prediction.target.pose);
  message.twist =
      prf_ros::to_twist(prediction.target.linear_velocity, prediction.target.angular_velocity);
  Eigen::Map<RowMajor6d>(message.covariance.data()) = prediction.covariance;
  return message;
}

}  // namespace

CheckedMeasurement to_measurement(const prf_msgs::TagDetection& detection,
                                  const MeasurementDefaults& defaults) {
  const auto& pose = detection.pose.pose;
  CheckedMeasurement checked =
      check(prf_ros::to_core(pose.position), prf_ros::to_core(pose.orientation),
            Eigen::Map<const RowMajor6d>(detection.pose.covariance.data()), defaults);
  if (checked.measurement) {
    checked.measurement = with_alternative(*checked.measurement,
                                           prf_ros::to_core(detection.alternative_pose.orientation),
                                           detection.ambiguity);
  }
  return checked;
}

prf_msgs::TargetForecast to_message(const TrackState& state,
                                    const std::vector<prf_core::TargetPrediction>& predictions,
                                    const std::string& planning_frame) {
  prf_msgs::TargetForecast message;
  message.header.stamp = prf_ros::to_ros_time(state.stamp);
  message.header.frame_id = planning_frame;
  message.status = prf_ros::to_message(state.status);
  message.measured = state.measured;
  message.nis = state.nis;
  if (state.belief) {
    message.since_measurement = prf_ros::to_ros_duration(
        prf_core::from_seconds(std::min(state.since_accepted(), kLongestAge)));
  }
  const prf_core::MeasuredMotion motion = state.measured_motion.at(state.stamp);
  message.measured_velocity = prf_ros::to_vector3(motion.velocity);
  Eigen::Map<RowMajor3d>(message.measured_velocity_covariance.data()) = motion.velocity_covariance;
  message.measured_speed = motion.speed;
  for (const auto& prediction : predictions) message.predictions.push_back(to_message(prediction));
  return message;
}

}  // namespace prf_predictor
