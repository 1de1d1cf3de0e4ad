// SPDX-License-Identifier: BSD-3-Clause
#include <cv_bridge/cv_bridge.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_ros/transform_broadcaster.h>

#include <prf_ros/conversions.hpp>
#include <prf_ros/private_parameters.hpp>
#include <set>
#include <stdexcept>

#include "conversions.hpp"
#include "params.hpp"
#include "prf_perception/stamp_join.hpp"
#include "prf_perception/tag_detector.hpp"

namespace prf_perception {
namespace {

namespace encodings = sensor_msgs::image_encodings;
namespace topics = prf_msgs::topics;

class TagDetectorNode {
 public:
  TagDetectorNode(ros::NodeHandle node, const TagDetectorNodeParams& params)
      : params_(params),
        detector_(params.detector),
        join_(prf_core::from_seconds(params.info_wait)) {
    const auto hints = ros::TransportHints().tcpNoDelay();
    updater_.setHardwareID("none");
    updater_.add("images", this, &TagDetectorNode::diagnose);
    info_subscriber_ =
        node.subscribe(topics::kCameraCameraInfo, 100, &TagDetectorNode::on_info, this, hints);
    image_subscriber_ =
        node.subscribe(topics::kCameraImageRaw, 10, &TagDetectorNode::on_image, this, hints);
    // Advertised last: whoever sees this publisher may send, both topics are subscribed.
    publisher_ = node.advertise<prf_msgs::TagDetectionArray>(topics::kTagDetections, 100);
  }

 private:
  using Join = StampJoin<sensor_msgs::ImageConstPtr, sensor_msgs::CameraInfoConstPtr>;

  void on_image(const sensor_msgs::ImageConstPtr& image) {
    if (join_.push_first(prf_ros::to_core(image->header.stamp), image)) {
      ROS_WARN("image stamps went back to %.3f s: new run", image->header.stamp.toSec());
      updater_.force_update();
    }
    detect_joined();
  }

  void on_info(const sensor_msgs::CameraInfoConstPtr& info) {
    join_.push_second(prf_ros::to_core(info->header.stamp), info);
    detect_joined();
  }

  void detect_joined() {
    while (const auto joined = join_.pop()) {
      const std_msgs::Header& header = joined->first->header;
      std::vector<TagDetection> found;
      try {
        found = detect(*joined);
      } catch (const std::exception& error) {
        ++refused_;
        ROS_WARN_THROTTLE(1.0, "image at %.3f s refused: %s", header.stamp.toSec(), error.what());
      }
      const auto message = to_message(header, params_.detector.family, found);
      publisher_.publish(message);
      broadcast(message);
      ++images_;
      tags_ += found.size();
    }
    updater_.update();
  }

  std::vector<TagDetection> detect(const Join::Joined& joined) {
    const sensor_msgs::Image& image = *joined.first;
    if (image.header.frame_id.empty()) throw std::invalid_argument("its frame_id is empty");
    if (!joined.second) throw std::invalid_argument("no camera_info has its stamp");
    if (image.encoding != encodings::MONO8 && image.encoding != encodings::BGR8 &&
        image.encoding != encodings::RGB8) {
      throw std::invalid_argument("encoding = " + image.encoding + ", must be mono8, bgr8 or rgb8");
    }
    const auto grey = cv_bridge::toCvShare(joined.first, encodings::MONO8);
    return detector_.detect(
        {grey->image.data, grey->image.cols, grey->image.rows, static_cast<int>(grey->image.step)},
        to_intrinsics(**joined.second));
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
        ROS_WARN_THROTTLE(1.0, "tag id %d is more than once in an image", detection.id);
      }
    }
    if (!transforms.empty()) broadcaster_.sendTransform(transforms);
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    if (refused_ > 0) {
      status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "images were refused");
    } else {
      status.summary(diagnostic_msgs::DiagnosticStatus::OK, "all images were read");
    }
    status.add("images", images_);
    status.add("tags", tags_);
    status.add("images refused", refused_);
    status.add("tags with a duplicate id", duplicates_);
  }

  TagDetectorNodeParams params_;
  TagDetector detector_;
  Join join_;
  std::size_t images_ = 0;
  std::size_t tags_ = 0;
  std::size_t refused_ = 0;
  std::size_t duplicates_ = 0;
  ros::Publisher publisher_;
  ros::Subscriber image_subscriber_;
  ros::Subscriber info_subscriber_;
  tf2_ros::TransformBroadcaster broadcaster_;
  diagnostic_updater::Updater updater_;
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
