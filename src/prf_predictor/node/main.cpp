// SPDX-License-Identifier: BSD-3-Clause
#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/TagDetectionArray.h>
#include <prf_msgs/TargetForecast.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <deque>
#include <map>
#include <memory>
#include <string>

#include "camera_transforms.hpp"
#include "conversions.hpp"
#include "leap_guard.hpp"
#include "params.hpp"

namespace prf_predictor {
namespace {

const ros::Duration kNewRun(1.0);

class TargetPredictorNode {
 public:
  TargetPredictorNode(ros::NodeHandle node, const NodeParams& params)
      : params_(params),
        transforms_(params.planning_frame, ros::Duration(params.tf_wait)),
        tracker_(params.tracker, params.predictor) {
    const auto hints = ros::TransportHints().tcpNoDelay();
    updater_.setHardwareID("none");
    updater_.add("target", this, &TargetPredictorNode::diagnose);
    using Tf = tf2_msgs::TFMessageConstPtr;
    subscribers_ = {
        node.subscribe<tf2_msgs::TFMessage>(
            "/tf_static", 100, [this](const Tf& tf) { on_tf(*tf, true); }, nullptr, hints),
        node.subscribe<tf2_msgs::TFMessage>(
            "/tf", 1000, [this](const Tf& tf) { on_tf(*tf, false); }, nullptr, hints),
        node.subscribe("tag_detections", 100, &TargetPredictorNode::on_detections, this, hints)};
    // After subscribing: who sees this publisher may start, nothing will be missed.
    publisher_ = node.advertise<prf_msgs::TargetForecast>("target/forecast", 100);
  }

 private:
  void on_tf(const tf2_msgs::TFMessage& message, bool is_static) {
    transforms_.add(message, is_static);
    answer_what_is_ready();
  }

  void on_detections(const ros::MessageEvent<const prf_msgs::TagDetectionArray>& event) {
    watch_publisher(event.getPublisherName());
    const auto array = event.getConstMessage();
    const auto [taken, refused] = guard_.take(array->header.stamp, array);
    if (refused) drop("stamp far in the future", "");
    for (const auto& next : taken) enqueue(next);
    answer_what_is_ready();
  }

  void enqueue(const prf_msgs::TagDetectionArrayConstPtr& array) {
    const ros::Time stamp = array->header.stamp;
    if (stamp + kNewRun < newest_) {
      ROS_WARN("detection stamps went back from %.3f to %.3f s: new run", newest_.toSec(),
               stamp.toSec());
      for (; !waiting_.empty(); waiting_.pop_front()) answer(*waiting_.front(), {});
      transforms_.begin_run(stamp);
      updater_.force_update();
    }
    newest_ = stamp;
    waiting_.push_back(array);
  }

  void watch_publisher(const std::string& name) {
    if (!source_.empty() && name != source_) {
      ++counts_["changes of publisher"];
      ROS_WARN_THROTTLE(1.0, "tag_detections came from %s and now from %s: two publishers?",
                        source_.c_str(), name.c_str());
    }
    source_ = name;
  }

  // Strictly in order: the first one waits for its tf, the others for the first.
  void answer_what_is_ready() {
    while (!waiting_.empty()) {
      const auto array = waiting_.front();
      const auto found = camera_at(*array);
      const bool is_overdue = newest_ > array->header.stamp + ros::Duration(params_.tf_wait);
      if (found.readiness == CameraTransforms::Readiness::kWait && !is_overdue) return;
      waiting_.pop_front();
      answer(*array, found);
    }
    updater_.update();
  }

  CameraTransforms::Lookup camera_at(const prf_msgs::TagDetectionArray& array) const {
    if (array.detections.empty()) {
      CameraTransforms::Lookup not_needed;
      not_needed.readiness = CameraTransforms::Readiness::kReady;
      return not_needed;
    }
    return transforms_.lookup(array.header.frame_id, array.header.stamp);
  }

  void answer(const prf_msgs::TagDetectionArray& array, const CameraTransforms::Lookup& camera) {
    std::vector<TagMeasurement> sights;
    if (camera.readiness == CameraTransforms::Readiness::kReady) {
      sights = sights_of(array, camera.camera_in_planning);
    } else {
      drop("without tf", camera.reason);
    }
    const auto [arrival, state] =
        tracker_.process(static_cast<Nanoseconds>(array.header.stamp.toNSec()), sights);
    publisher_.publish(to_message(state, tracker_.forecast(state, params_.horizons), array.header,
                                  params_.planning_frame));
    status_ = state.status;
    ++counts_["images"];
    if (state.measured) ++counts_["measurements accepted"];
    if (arrival == Arrival::kDuplicate) drop("duplicate stamp", "");
    if (arrival == Arrival::kTooOld) drop("older than all history", "");
    if (arrival == Arrival::kReplayed) ++counts_["images replayed out of order"];
    if (state.gated) drop("outside the gate", "NIS " + std::to_string(state.nis));
    if (state.orientation_gated) drop("orientation outside the gate", "");
    if (state.reacquired) ++counts_["targets re-acquired"];
    if (state.reinitialised) drop("belief not finite", "filter starts anew");
  }

  std::vector<TagMeasurement> sights_of(const prf_msgs::TagDetectionArray& array,
                                        const Eigen::Isometry3d& camera_in_planning) {
    std::vector<TagMeasurement> sights;
    for (const auto& detection : array.detections) {
      if (detection.id != params_.tag_id) continue;
      const auto checked = to_measurement(detection, params_.defaults);
      if (checked.status == MeasurementStatus::kCovarianceReplaced) ++counts_["default covariance"];
      if (checked.status == MeasurementStatus::kNotFinite) drop("not finite", "");
      if (checked.status == MeasurementStatus::kNoOrientation) drop("quaternion not unit", "");
      if (!checked.measurement) continue;
      sights.push_back(camera_in_planning * *checked.measurement);
      sights.back().position_covariance *= params_.measurement_scale;
    }
    if (sights.size() > 1) drop("several tags of the target's id", "the nearest is used");
    return sights;
  }

  void drop(const std::string& reason, const std::string& detail) {
    ++counts_["dropped: " + reason];
    ROS_WARN_THROTTLE(1.0, "measurement dropped, %s %s", reason.c_str(), detail.c_str());
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    static constexpr const char* kNames[] = {"no target", "tracking", "coasting", "lost"};
    const bool is_good = status_ == TrackStatus::kTracking;
    status.summary(
        is_good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
        kNames[static_cast<int>(status_)]);
    status.add("waiting for tf", waiting_.size());
    for (const auto& [name, count] : counts_) status.add(name, count);
  }

  NodeParams params_;
  CameraTransforms transforms_;
  TargetTracker tracker_;
  LeapGuard<prf_msgs::TagDetectionArrayConstPtr> guard_;
  std::string source_;  // node that sent the latest detections
  std::deque<prf_msgs::TagDetectionArrayConstPtr> waiting_;
  ros::Time newest_;
  TrackStatus status_ = TrackStatus::kNoTarget;
  std::map<std::string, std::size_t> counts_;
  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_updater::Updater updater_;
};

}  // namespace
}  // namespace prf_predictor

int main(int argc, char** argv) {
  ros::init(argc, argv, "target_predictor");
  return prf_ros::run([] {
    prf_predictor::TargetPredictorNode node(ros::NodeHandle(),
                                            prf_predictor::load(ros::NodeHandle("~")));
    ros::spin();
  });
}
