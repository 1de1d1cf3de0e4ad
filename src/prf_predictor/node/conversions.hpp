// SPDX-License-Identifier: BSD-3-Clause
// Messages to core types and back.
#pragma once

#include <prf_msgs/TagDetection.h>
#include <prf_msgs/TargetForecast.h>

#include <string>
#include <vector>

#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {

inline CheckedMeasurement to_measurement(const prf_msgs::TagDetection& detection,
                                         const MeasurementDefaults& defaults) {
  const auto& position = detection.pose.pose.position;
  const auto& orientation = detection.pose.pose.orientation;
  using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  return check({position.x, position.y, position.z},
               {orientation.w, orientation.x, orientation.y, orientation.z},
               Eigen::Map<const RowMajor6d>(detection.pose.covariance.data()), defaults);
}

inline std::uint8_t to_message(TrackStatus status) {
  switch (status) {
    case TrackStatus::kNoTarget:
      return prf_msgs::TargetForecast::NO_TARGET;
    case TrackStatus::kTracking:
      return prf_msgs::TargetForecast::TRACKING;
    case TrackStatus::kCoasting:
      return prf_msgs::TargetForecast::COASTING;
    case TrackStatus::kLost:
      break;
  }
  return prf_msgs::TargetForecast::LOST;
}

template <typename Message>
void assign(Message& message, const Eigen::Vector3d& vector) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

inline prf_msgs::TargetPrediction to_message(const Prediction& prediction) {
  prf_msgs::TargetPrediction message;
  message.horizon.fromSec(prediction.horizon);
  assign(message.pose.position, prediction.point.position);
  message.pose.orientation.x = prediction.rotation.orientation.x();
  message.pose.orientation.y = prediction.rotation.orientation.y();
  message.pose.orientation.z = prediction.rotation.orientation.z();
  message.pose.orientation.w = prediction.rotation.orientation.w();
  assign(message.twist.linear, prediction.point.velocity);
  assign(message.twist.angular, prediction.rotation.rate);
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.covariance.data()) =
      prediction.point.covariance;
  return message;
}

inline prf_msgs::TargetForecast to_message(const TrackState& state,
                                           const std::vector<Prediction>& predictions,
                                           const std_msgs::Header& image,
                                           const std::string& planning_frame) {
  prf_msgs::TargetForecast message;
  message.header.stamp = image.stamp;
  message.header.frame_id = planning_frame;
  message.status = to_message(state.status);
  message.measured = state.measured;
  message.nis = state.nis;
  if (state.belief) message.since_measurement.fromNSec(state.stamp - state.last_accepted);
  for (const Prediction& prediction : predictions) {
    message.predictions.push_back(to_message(prediction));
  }
  return message;
}

}  // namespace prf_predictor
