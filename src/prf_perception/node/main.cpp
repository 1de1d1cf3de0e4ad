// SPDX-License-Identifier: BSD-3-Clause
#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <prf_core/bounds.hpp>
#include <prf_ros/conversions.hpp>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/private_parameters.hpp>
#include <prf_ros/wall_throttle.hpp>
#include <set>
#include <stdexcept>

#include "conversions.hpp"
#include "params.hpp"
#include "prf_perception/stamp_join.hpp"
#include "prf_perception/tag_detector.hpp"

namespace prf_perception {
namespace {

namespace topics = prf_msgs::topics;

constexpr double kRate = 30.0;  // Hz, of images
constexpr const char* kBadStamp = "its stamp is at an end of ROS time";

const char* what_is_wrong(prf_core::StampOrder order) {
  switch (order) {
    case prf_core::StampOrder::kDuplicate:
      return "an image of its stamp has come before";
    case prf_core::StampOrder::kOld:
      return "its stamp is older than that of an image before";
    default:
      return "its stamp is too far ahead of the image before";
  }
}

class TagDetectorNode {
 public:
  TagDetectorNode(ros::NodeHandle node, const TagDetectorNodeParams& params)
      : params_(params),
        detector_(params.detector),
        join_(prf_core::from_seconds(params.info_wait)),
        inputs_(node, &updater_) {
    updater_.setHardwareID("none");
    updater_.add("images", this, &TagDetectorNode::diagnose);
    inputs_.subscribe<sensor_msgs::CameraInfo>(
        {topics::kCameraCameraInfo, "sensor_msgs/CameraInfo with the stamp of each image", kRate},
        100, [this](const sensor_msgs::CameraInfoConstPtr& info) { on_info(info); });
    inputs_.subscribe<sensor_msgs::Image>(
        {topics::kCameraImageRaw, "sensor_msgs/Image", kRate}, 10,
        [this](const sensor_msgs::ImageConstPtr& image) { on_image(image); });
    // Advertised last: whoever sees this publisher may send, both topics are subscribed.
    publisher_ = node.advertise<prf_msgs::TagDetectionArray>(topics::kTagDetections, 100);
  }

 private:
  using Join = StampJoin<sensor_msgs::ImageConstPtr, sensor_msgs::CameraInfoConstPtr>;

  void on_image(const sensor_msgs::ImageConstPtr& image) {
    const auto stamp = prf_ros::usable_stamp(image->header.stamp);
    if (!stamp) return inputs_.drop(topics::kCameraImageRaw, kBadStamp);
    const prf_core::StampOrder order = join_.push_first(*stamp, image);
    if (order == prf_core::StampOrder::kBackwardJump) {
      ROS_WARN("image stamps went back to %.3f s: new run", image->header.stamp.toSec());
      updater_.force_update();
    } else if (!prf_core::is_accepted(order)) {
      inputs_.drop(topics::kCameraImageRaw, what_is_wrong(order));
    }
    detect_joined();
  }

  void on_info(const sensor_msgs::CameraInfoConstPtr& info) {
    const auto stamp = prf_ros::usable_stamp(info->header.stamp);
    if (!stamp) return inputs_.drop(topics::kCameraCameraInfo, kBadStamp);
    if (!join_.push_second(*stamp, info)) {
      inputs_.drop(topics::kCameraCameraInfo, "one of its stamp has come before");
    }
    detect_joined();
  }

  void detect_joined() {
    while (const auto joined = join_.pop()) {
      const std_msgs::Header& header = joined->first->header;
      std_msgs::Header exposed = header;
      exposed.stamp = prf_ros::to_ros_time(exposure_of(prf_ros::to_core(header.stamp)));
      std::vector<TagDetection> found;
      try {
        found = detect(*joined);
      } catch (const std::exception& error) {
        inputs_.drop(topics::kCameraImageRaw, "it cannot be used with its camera_info");
        if (refusals_.is_due()) {
          ROS_WARN("image at %.3f s refused: %s", header.stamp.toSec(), error.what());
        }
      }
      const auto message = to_message(exposed, params_.detector.family, found);
      publisher_.publish(message);
      broadcast(message);
      ++images_;
      tags_ += found.size();
    }
    updater_.update();
  }

  // The middle of the exposure of an image with this stamp.
  [[nodiscard]] prf_core::Stamp exposure_of(prf_core::Stamp stamp) const {
    return std::max(prf_core::kMinStamp, stamp - prf_core::from_seconds(params_.stamp_offset));
  }

  std::vector<TagDetection> detect(const Join::Joined& joined) {
    const sensor_msgs::Image& image = *joined.first;
    if (image.header.frame_id.empty())
      throw std::invalid_argument("its frame_id is empty, must name the camera's optical frame");
    if (!joined.second)
      throw std::invalid_argument("no camera_info has its stamp, must come with each image");
    const auto grey = to_grey(joined.first);
    const CameraIntrinsics camera = to_intrinsics(**joined.second, image);
    camera.validate();
    return detector_.detect(
        {grey->image.data, grey->image.cols, grey->image.rows, static_cast<int>(grey->image.step)},
        camera);
  }

  // Of several tags with one id the first, which has the largest margin, gives the frame.
  void broadcast(const prf_msgs::TagDetectionArray& array) {
    std::set<int> sent;
    std::vector<geometry_msgs::TransformStamped> transforms;
    for (const auto& detection : array.detections) {
      if (params_.tag_ids.count(detection.id) == 0) continue;
      if (sent.insert(detection.id).second) {
        transforms.push_back(to_transform(array.header, detection));
      } else {
        ++duplicates_;
        if (doubled_.is_due())
          ROS_WARN(
              "tag id %d is more than once in an image, must be there once: are two tags of this "
              "id about, or a mirror?",
              detection.id);
      }
    }
    if (!transforms.empty()) broadcaster_.sendTransform(transforms);
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "images are read");
    status.add("images", images_);
    status.add("tags", tags_);
    status.add("tags with a duplicate id", duplicates_);
    inputs_.report(status);
  }

  TagDetectorNodeParams params_;
  TagDetector detector_;
  Join join_;
  std::size_t images_ = 0;
  std::size_t tags_ = 0;
  std::size_t duplicates_ = 0;
  prf_ros::WallThrottle refusals_, doubled_;
  ros::Publisher publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  diagnostic_updater::Updater updater_;
  prf_ros::InputMonitor inputs_;
};

}  // namespace
}  // namespace prf_perception

int main(int argc, char** argv) {
  ros::init(argc, argv, "tag_detector");
  return prf_ros::run([] {
    prf_perception::TagDetectorNode node(ros::NodeHandle(),
                                         prf_perception::load_params(ros::NodeHandle("~")));
    ros::spin();
  });
}
