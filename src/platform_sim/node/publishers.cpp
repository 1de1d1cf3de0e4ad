// SPDX-License-Identifier: BSD-3-Clause
#include "publishers.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <prf_msgs/ground_truth_topics.h>
#include <prf_msgs/topics.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>
#include <visualization_msgs/MarkerArray.h>

#include "conversions.hpp"

namespace platform_sim {
namespace {

namespace topics = prf_msgs::topics;
namespace truth = prf_msgs::ground_truth_topics;

constexpr std::uint32_t kQueueSize = 1000;
// 10 s, 92 MB: lockstep does not wait for a recorder that a busy machine holds up.
constexpr std::uint32_t kImageQueueSize = 300;
const std::string kOpticalFrame = "camera_optical_frame";
const std::string kTagFrame = "tag_0";

std_msgs::Header header_at(std::int64_t now_ms, const std::string& frame) {
  std_msgs::Header header;
  header.stamp = to_stamp(now_ms);
  header.frame_id = frame;
  return header;
}

}  // namespace

SimPublishers::SimPublishers(ros::NodeHandle& node, bool with_joint_states, bool is_disturbed)
    : clock_(node.advertise<rosgraph_msgs::Clock>(topics::kClock, kQueueSize)),
      image_(node.advertise<sensor_msgs::Image>(topics::kCameraImageRaw, kImageQueueSize)),
      camera_info_(node.advertise<sensor_msgs::CameraInfo>(topics::kCameraCameraInfo, kQueueSize)),
      joint_states_(with_joint_states
                        ? node.advertise<sensor_msgs::JointState>(topics::kJointStates, kQueueSize)
                        : ros::Publisher()),
      obstacles_(node.advertise<visualization_msgs::MarkerArray>(topics::kObstacles, 1, true)),
      diagnostics_(node.advertise<diagnostic_msgs::DiagnosticArray>(topics::kDiagnostics, 10)),
      platform_(node.advertise<nav_msgs::Odometry>(truth::kGroundTruthPlatform, kQueueSize)),
      base_(node.advertise<nav_msgs::Odometry>(truth::kGroundTruthBase, kQueueSize)),
      tag_(node.advertise<geometry_msgs::PoseStamped>(truth::kGroundTruthTag, kQueueSize)),
      camera_(node.advertise<geometry_msgs::PoseStamped>(truth::kGroundTruthCamera, kQueueSize)),
      end_effector_(
          node.advertise<geometry_msgs::PoseStamped>(truth::kGroundTruthEndEffector, kQueueSize)),
      contacts_(node.advertise<prf_msgs::ContactArray>(truth::kGroundTruthContacts, kQueueSize)) {
  if (is_disturbed) events_ = node.advertise<std_msgs::String>(topics::kFaultEvents, kQueueSize);
}

void SimPublishers::publish_obstacles(const camera_sim::TargetBox& target) {
  if (!target.obstructed) return;
  const camera_sim::Cuboid post = target.obstacle();
  visualization_msgs::MarkerArray message;
  visualization_msgs::Marker& marker = message.markers.emplace_back();
  marker.header.frame_id = kTagFrame;
  marker.ns = "obstacles";
  marker.type = visualization_msgs::Marker::CUBE;
  marker.pose = prf_ros::to_message(
      prf_core::pose_from(target.tag_in_platform().inverse() * post.pose_in_platform));
  marker.scale = prf_ros::to_vector3(post.size);
  marker.color.r = 0.8F;
  marker.color.a = 1.0F;
  marker.frame_locked = 1;
  obstacles_.publish(message);
}

void SimPublishers::publish_clock(std::int64_t now_ms) {
  rosgraph_msgs::Clock message;
  message.clock = to_stamp(now_ms);
  clock_.publish(message);
}

void SimPublishers::publish_image(std::int64_t stamp_ms, const cv::Mat& image,
                                  const camera_sim::PinholeCamera& camera) {
  const std_msgs::Header header = header_at(stamp_ms, kOpticalFrame);
  sensor_msgs::CameraInfo info = to_camera_info(camera);
  info.header = header;
  camera_info_.publish(info);
  image_.publish(to_image(header, image));
}

void SimPublishers::publish_ground_truth(std::int64_t now_ms, World& world) {
  const std_msgs::Header header = header_at(now_ms, "world");
  const std::string ground = world.target().on_cart ? "floor" : "platform";
  platform_.publish(to_odometry(header, ground, world.platform()));
  base_.publish(to_odometry(header, world.base_link(), world.base()));
  tag_.publish(to_pose_stamped(header, world.tag().pose));
  camera_.publish(to_pose_stamped(header, world.frame(kOpticalFrame).pose));
  end_effector_.publish(to_pose_stamped(header, world.frame(world.robot().hand).pose));
  contacts_.publish(to_contact_array(header, world.take_contacts()));
}

void SimPublishers::publish_disturbances(std::int64_t now_ms, const World& world) {
  if (!events_) return;
  for (const Disturbances::Acting& acting : world.disturbances().acting(world.time())) {
    std_msgs::String message;
    message.data = R"({"stamp": )" + std::to_string(to_stamp(now_ms).toNSec()) + R"(, "fault": ")" +
                   acting.word + R"(", "what": ")" +
                   (told_.insert(acting.word).second ? acting.what : "") + R"("})";
    events_.publish(message);
  }
}

void SimPublishers::publish_joint_states(std::int64_t now_ms, const World& world) {
  joint_states_.publish(to_joint_state(to_stamp(now_ms), world.joint_names(), world.joints()));
}

void SimPublishers::publish_diagnostics(std::int64_t now_ms, double real_time_factor,
                                        double ticks_per_second, unsigned refused,
                                        unsigned unanswered) {
  const auto entry = [](const std::string& key, double value) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = std::to_string(value);
    return pair;
  };
  diagnostic_msgs::DiagnosticArray message;
  message.header = header_at(now_ms, "");
  diagnostic_msgs::DiagnosticStatus& status = message.status.emplace_back();
  status.level = refused == 0 && unanswered == 0 ? diagnostic_msgs::DiagnosticStatus::OK
                                                 : diagnostic_msgs::DiagnosticStatus::WARN;
  status.name = "platform_sim: lockstep";
  status.message = refused != 0      ? "commands were refused"
                   : unanswered != 0 ? "went on without responses"
                                     : "running";
  status.values = {entry("real_time_factor", real_time_factor),
                   entry("ticks_per_wall_second", ticks_per_second),
                   entry("refused_commands", refused), entry("ticks_without_response", unanswered)};
  diagnostics_.publish(message);
}

unsigned SimPublishers::subscribers() const {
  unsigned count = 0;
  for (const ros::Publisher* publisher :
       {&clock_, &image_, &camera_info_, &joint_states_, &obstacles_, &platform_, &base_, &tag_,
        &camera_, &end_effector_, &contacts_}) {
    if (*publisher) count += publisher->getNumSubscribers();
  }
  return count;
}

std::vector<std::string> SimPublishers::without_subscriber(bool camera_too) const {
  std::vector<std::string> names;
  if (joint_states_ && joint_states_.getNumSubscribers() == 0)
    names.push_back(joint_states_.getTopic());
  if (camera_too && image_.getNumSubscribers() == 0) names.push_back(image_.getTopic());
  return names;
}

}  // namespace platform_sim
