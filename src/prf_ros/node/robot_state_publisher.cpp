// SPDX-License-Identifier: BSD-3-Clause
// tf of the robot, one message for every joint_states.
//
// It replaces Debian's robot_state_publisher. That node keeps only the newest of the joint_states
// that wait for it, and its library stamps fixed frames with the present time: the frames that the
// framework sees would depend on the load of the machine.
//
// A message without a joint of the robot, with a position that is no angle, or with a stamp that is
// old, doubled or far ahead gives no tf. Drivers that send different joints have a clock each.
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/TransformStamped.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <map>
#include <prf_core/bounds.hpp>
#include <prf_core/clock_monitor.hpp>
#include <string>
#include <vector>

#include "prf_ros/conversions.hpp"
#include "prf_ros/frame_tree.hpp"
#include "prf_ros/input_monitor.hpp"
#include "prf_ros/private_parameters.hpp"

namespace prf_ros {
namespace {

using sensor_msgs::JointState;

constexpr unsigned kQueue = 1000;
constexpr double kTickPeriod = 0.01;  // s, unless ~tick_period says another one
constexpr std::size_t kNamesShown = 10;

std::vector<geometry_msgs::TransformStamped> to_messages(const std::vector<LinkFrame>& frames,
                                                         const ros::Time& stamp) {
  std::vector<geometry_msgs::TransformStamped> messages;
  for (const LinkFrame& frame : frames) {
    geometry_msgs::TransformStamped message;
    message.header.stamp = stamp;
    message.header.frame_id = frame.parent;
    message.child_frame_id = frame.child;
    message.transform.translation = to_vector3(frame.child_in_parent.translation());
    message.transform.rotation = to_message(Eigen::Quaterniond(frame.child_in_parent.linear()));
    messages.push_back(message);
  }
  return messages;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kNamesShown); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return text + (names.size() > kNamesShown ? " and others" : "");
}

class RobotStatePublisher {
 public:
  RobotStatePublisher() : tree_(node_.param<std::string>("robot_description", "")) {
    fixed_.sendTransform(to_messages(tree_.fixed(), ros::Time(0)));
    diagnostics_.setHardwareID("none");
    diagnostics_.add("frames", this, &RobotStatePublisher::diagnose);
    inputs_.subscribe<JointState>(
        {prf_msgs::topics::kJointStates,
         "sensor_msgs/JointState with joints of the robot: " + listed(tree_.moving_joints()),
         1.0 / tick_period()},
        kQueue, [this](const sensor_msgs::JointStateConstPtr& message) { receive(*message); });
  }

 private:
  static double tick_period() {
    const double period = ros::NodeHandle("~").param("tick_period", kTickPeriod);
    prf_core::require_between("tick_period", period, 0.001, 0.1, "s");
    return period;
  }

  void receive(const JointState& message) {
    const std::string reason = refusal(message);
    if (reason.empty()) {
      moving_.sendTransform(
          to_messages(tree_.moving(message.name, message.position), message.header.stamp));
      ++published_;
    } else {
      inputs_.drop(prf_msgs::topics::kJointStates, reason);
    }
    diagnostics_.update();
  }

  // Why the message gives no tf; empty: it does.
  std::string refusal(const JointState& message) {
    const auto stamp = usable_stamp(message.header.stamp);
    if (!stamp) return "its stamp is near the end of ROS time";
    const auto known =
        std::find_if(message.name.begin(), message.name.end(),
                     [this](const std::string& name) { return tree_.is_moving_joint(name); });
    if (known == message.name.end()) return "it has no joint of the robot";
    for (std::size_t i = 0; i < message.name.size(); ++i) {
      if (!tree_.is_moving_joint(message.name[i])) continue;
      if (i >= message.position.size()) return message.name[i] + " has no position";
      if (!prf_core::is_within(message.position[i], prf_core::kMaxJointPosition)) {
        return "the position of " + message.name[i] + " is no joint position";
      }
    }
    switch (clocks_[*known].observe(*stamp)) {
      case prf_core::StampOrder::kDuplicate:
        return "its stamp came before";
      case prf_core::StampOrder::kOld:
        return "its stamp is older than one that came before";
      case prf_core::StampOrder::kFarAhead:
        return "its stamp is far ahead";
      case prf_core::StampOrder::kBackwardJump:
        ROS_WARN("the clock of %s went back: new run", prf_msgs::topics::kJointStates);
        break;
      case prf_core::StampOrder::kForwardJump:
      case prf_core::StampOrder::kNewer:
        break;
    }
    return "";
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "publishing tf");
    status.add("messages of tf", published_);
    inputs_.report(status);
  }

  ros::NodeHandle node_;
  FrameTree tree_;
  tf2_ros::StaticTransformBroadcaster fixed_;
  tf2_ros::TransformBroadcaster moving_;
  std::map<std::string, prf_core::ClockMonitor> clocks_;  // by the first joint of a message
  std::uint64_t published_ = 0;
  diagnostic_updater::Updater diagnostics_;
  InputMonitor inputs_{node_, &diagnostics_};
};

}  // namespace
}  // namespace prf_ros

int main(int argc, char** argv) {
  ros::init(argc, argv, "robot_state_publisher");
  return prf_ros::run([] {
    const prf_ros::RobotStatePublisher publisher;
    ros::spin();
  });
}
