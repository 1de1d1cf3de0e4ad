// SPDX-License-Identifier: BSD-3-Clause
// The node stand_in_arm: joint_states + joint_command -> rehearsal/joint_states, in which the arm
// does what the commands say. It has parameters of its own, so that it needs no driver.
#include "prf_drivers/stand_in_arm.hpp"

#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <prf_ros/conversions.hpp>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/private_parameters.hpp>

#include "params.hpp"
#include "picked.hpp"

namespace prf_drivers {
namespace {

namespace topics = prf_msgs::topics;

constexpr std::uint32_t kQueue = 1000;  // messages

class StandInNode {
 public:
  StandInNode(ros::NodeHandle& node, const StandInNodeParams& params)
      : params_(params),
        arm_(params.stand_in),
        states_(node.advertise<sensor_msgs::JointState>("rehearsal/joint_states", kQueue)),
        inputs_(node, &diagnostics_) {
    diagnostics_.setHardwareID("none");
    diagnostics_.add("stand-in", this, &StandInNode::diagnose);
    inputs_.subscribe<sensor_msgs::JointState>(
        {topics::kJointStates, "sensor_msgs/JointState with the arm", 0.0}, kQueue,
        [this](const sensor_msgs::JointStateConstPtr& message) { on_joints(*message); });
    inputs_.subscribe<trajectory_msgs::JointTrajectory>(
        {topics::kJointCommand, "trajectory_msgs/JointTrajectory with the arm", 0.0}, kQueue,
        [this](const trajectory_msgs::JointTrajectoryConstPtr& message) { on_command(*message); });
  }

 private:
  void on_joints(const sensor_msgs::JointState& message) {
    const auto stamp = prf_ros::usable_stamp(message.header.stamp);
    const auto measured = picked(params_.joints, message.name, message.position);
    if (!stamp || !measured) {
      inputs_.drop(topics::kJointStates, stamp ? "without a joint of the arm" : "unusable stamp");
      return;
    }
    const auto state = arm_.at(*stamp, *measured);
    if (!state) {
      inputs_.drop(topics::kJointStates, "not newer, or not finite");
      return;
    }
    sensor_msgs::JointState stand_in = message;
    stand_in.velocity.resize(message.name.size(), 0.0);
    stand_in.effort.assign(message.name.size(), 0.0);
    for (std::size_t i = 0; i < params_.joints.size(); ++i) {
      const auto found = std::find(stand_in.name.begin(), stand_in.name.end(), params_.joints[i]);
      const auto at = static_cast<std::size_t>(found - stand_in.name.begin());
      stand_in.position[at] = state->position[static_cast<Eigen::Index>(i)];
      stand_in.velocity[at] = state->velocity[static_cast<Eigen::Index>(i)];
    }
    states_.publish(stand_in);
    ++ticks_;
  }

  void on_command(const trajectory_msgs::JointTrajectory& message) {
    const auto stamp = prf_ros::usable_stamp(message.header.stamp);
    std::optional<Eigen::VectorXd> position;
    if (message.points.size() == 1) {
      position = picked(params_.joints, message.joint_names, message.points.front().positions);
    }
    if (!stamp || !position || !arm_.command(*stamp, *position)) {
      inputs_.drop(topics::kJointCommand, "not newer, or without finite positions of the arm");
    }
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& out) {
    out.summary(diagnostic_msgs::DiagnosticStatus::OK, "stands in for the arm");
    inputs_.report(out);
    out.add("ticks", ticks_);
  }

  StandInNodeParams params_;
  StandInArm arm_;
  ros::Publisher states_;
  diagnostic_updater::Updater diagnostics_;
  prf_ros::InputMonitor inputs_;
  unsigned long ticks_ = 0;
};

}  // namespace
}  // namespace prf_drivers

int main(int argc, char** argv) {
  ros::init(argc, argv, "stand_in_arm");
  ros::NodeHandle node;
  return prf_ros::run([&node] {
    const prf_drivers::StandInNode stand_in(node, prf_drivers::load_stand_in(ros::NodeHandle("~")));
    ros::spin();
  });
}
