// SPDX-License-Identifier: BSD-3-Clause
#include <prf_msgs/TagDetectionArray.h>
#include <prf_msgs/TargetForecast.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>
#include <prf_ros/conversions.hpp>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/private_parameters.hpp>

#include <deque>
#include <prf_core/clock_monitor.hpp>

#include "camera_transforms.hpp"
#include "conversions.hpp"
#include "health.hpp"
#include "params.hpp"

namespace prf_predictor {
namespace {

using prf_core::from_seconds;
using prf_core::StampOrder;
using prf_ros::to_core;
using Readiness = FrameChain::Readiness;
using ArrayPtr = prf_msgs::TagDetectionArrayConstPtr;

constexpr double kImageRate = 30.0;  // Hz

std::string seconds_text(Stamp stamp) { return std::to_string(prf_core::to_seconds(stamp)) + " s"; }

class TargetPredictorNode {
 public:
  TargetPredictorNode(ros::NodeHandle node, const TargetPredictorParams& params)
      : params_(params),
        inputs_(node, &health_.updater()),
        transforms_(params.planning_frame, params.tag_frame_prefix, from_seconds(params.tf_wait),
                    health_),
        tracker_(params.tracker, params.predictor) {
    using prf_msgs::topics::kTagDetections;
    inputs_.subscribe_events<tf2_msgs::TFMessage>(
        {prf_msgs::topics::kTfStatic, "tf2_msgs/TFMessage with the fixed frames of the robot", 0,
         prf_ros::Presence::kOnce, true},
        100, [this](const TfEvent& event) { on_tf(event, true); });
    inputs_.subscribe_events<tf2_msgs::TFMessage>(
        {prf_msgs::topics::kTf,
         "tf2_msgs/TFMessage with the frames between " + params.planning_frame + " and the camera",
         0, prf_ros::Presence::kContinuous, true},
        1000, [this](const TfEvent& event) { on_tf(event, false); });
    inputs_.subscribe<prf_msgs::TagDetectionArray>(
        {kTagDetections, "prf_msgs/TagDetectionArray, one for each image", kImageRate}, 100,
        [this](const ArrayPtr& array) { on_detections(array); });
    // After subscribing: a node that waits for this publisher may start, nothing is missed.
    health_.watch(inputs_);
    publisher_ = node.advertise<prf_msgs::TargetForecast>("target/forecast", 100);
  }

 private:
  using TfEvent = ros::MessageEvent<const tf2_msgs::TFMessage>;

  void on_tf(const TfEvent& event, bool is_static) {
    transforms_.add(*event.getConstMessage(), event.getPublisherName(), is_static);
    process_ready_images();
  }

  void on_detections(const ArrayPtr& array) {
    const auto stamp = prf_ros::usable_stamp(array->header.stamp);
    if (!stamp) {
      inputs_.drop(prf_msgs::topics::kTagDetections, "its stamp is near the end of ROS time");
      return;
    }
    const Stamp before = clock_.newest().value_or(*stamp);
    const StampOrder order = clock_.observe(*stamp);
    if (order == StampOrder::kBackwardJump) begin_run(before, *stamp);
    if (order == StampOrder::kFarAhead) {
      inputs_.drop(prf_msgs::topics::kTagDetections, "its stamp is far ahead");
    } else {
      waiting_.push_back(array);
    }
    process_ready_images();
  }

  void begin_run(Stamp before, Stamp stamp) {
    ROS_WARN("detection stamps went back from %s to %s: new run", seconds_text(before).c_str(),
             seconds_text(stamp).c_str());
    for (; !waiting_.empty(); waiting_.pop_front()) process(*waiting_.front(), {});
    transforms_.begin_run(stamp);
    health_.publish_now();
  }

  // Strictly in order: the first image waits for its tf, the others for the first.
  void process_ready_images() {
    while (!waiting_.empty()) {
      const ArrayPtr array = waiting_.front();
      const auto camera = camera_at(*array);
      const bool is_overdue =
          *clock_.newest() > to_core(array->header.stamp) + from_seconds(params_.tf_wait);
      if (camera.readiness == Readiness::kWait && !is_overdue) break;
      waiting_.pop_front();
      process(*array, camera);
    }
    health_.report_waiting(waiting_.size());
    if (waiting_.empty()) health_.publish();
  }

  FrameChain::LookupResult camera_at(const prf_msgs::TagDetectionArray& array) {
    if (array.detections.empty()) {
      FrameChain::LookupResult not_needed;
      not_needed.readiness = Readiness::kReady;
      return not_needed;
    }
    return transforms_.lookup(array.header.frame_id, to_core(array.header.stamp));
  }

  void process(const prf_msgs::TagDetectionArray& array, const FrameChain::LookupResult& camera) {
    std::vector<TagMeasurement> measurements;
    if (camera.readiness == Readiness::kReady) {
      measurements = measurements_of(array, camera.camera_in_planning);
    } else {
      health_.drop("without tf", camera.reason);
    }
    const auto result = tracker_.process(to_core(array.header.stamp), measurements);
    publisher_.publish(to_message(result.state, tracker_.forecast(result.state, params_.horizons),
                                  params_.planning_frame));
    health_.report(result);
  }

  std::vector<TagMeasurement> measurements_of(const prf_msgs::TagDetectionArray& array,
                                              const Eigen::Isometry3d& camera_in_planning) {
    std::vector<TagMeasurement> measurements;
    for (const auto& detection : array.detections) {
      if (detection.id != params_.tag_id) continue;
      const auto checked = to_measurement(detection, params_.defaults);
      if (checked.status == MeasurementStatus::kCovarianceReplaced) {
        health_.count("default covariance");
      }
      if (checked.status == MeasurementStatus::kNotFinite) health_.drop("not finite");
      if (checked.status == MeasurementStatus::kTooFar) health_.drop("more than 1000 m away");
      if (checked.status == MeasurementStatus::kNoOrientation) health_.drop("quaternion not unit");
      if (!checked.measurement) continue;
      measurements.push_back(camera_in_planning * *checked.measurement);
      measurements.back().position_covariance *= params_.measurement_scale;
    }
    if (measurements.size() > 1) {
      health_.drop("several tags of the target's id", "the nearest is used");
    }
    return measurements;
  }

  TargetPredictorParams params_;
  Health health_;
  prf_ros::InputMonitor inputs_;
  CameraTransforms transforms_;
  TargetTracker tracker_;
  prf_core::ClockMonitor clock_;  // of the images
  std::deque<ArrayPtr> waiting_;  // for tf
  ros::Publisher publisher_;
};

}  // namespace
}  // namespace prf_predictor

int main(int argc, char** argv) {
  ros::init(argc, argv, "target_predictor");
  return prf_ros::run([] {
    using namespace prf_predictor;
    TargetPredictorNode node(ros::NodeHandle(), load_params(ros::NodeHandle("~")));
    ros::spin();
  });
}
