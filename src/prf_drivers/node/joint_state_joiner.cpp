// SPDX-License-Identifier: BSD-3-Clause
// The node joint_state_joiner: joint states of the arm's driver and of others -> joint_states, one
// message for each control tick.
#include "prf_drivers/joint_state_joiner.hpp"

#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <prf_ros/conversions.hpp>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/private_parameters.hpp>

#include "params.hpp"

namespace prf_drivers {
namespace {

constexpr std::uint32_t kQueue = 1000;  // messages

class JoinerNode {
 public:
  JoinerNode(ros::NodeHandle& node, const JoinerNodeParams& params)
      : params_(params),
        joiner_(params.joiner),
        joint_states_(
            node.advertise<sensor_msgs::JointState>(prf_msgs::topics::kJointStates, kQueue)),
        inputs_(node, &diagnostics_) {
    diagnostics_.setHardwareID("none");
    diagnostics_.add("joint states", this, &JoinerNode::diagnose);
    listen(0, params.driver.state_topic, params.fill ? 0.0 : 1.0 / params.driver.period);
    for (std::size_t i = 0; i < params.other_topics.size(); ++i) {
      listen(i + 1, params.other_topics[i], 0.0);
    }
    if (params.fill) {
      timer_ = node.createTimer(ros::Duration(params.driver.period),
                                [this](const ros::TimerEvent&) { fill(); });
    }
  }

 private:
  void listen(std::size_t source, const std::string& topic, double rate) {
    inputs_.subscribe<sensor_msgs::JointState>(
        {topic,
         source == 0 ? "sensor_msgs/JointState of the arm's driver" : "sensor_msgs/JointState",
         rate},
        kQueue, [this, source, topic](const sensor_msgs::JointStateConstPtr& message) {
          receive(source, topic, *message);
        });
  }

  void receive(std::size_t source, const std::string& topic,
               const sensor_msgs::JointState& message) {
    const auto stamp = prf_ros::usable_stamp(message.header.stamp);
    if (!stamp) {
      inputs_.drop(topic, "unusable stamp");
      return;
    }
    const double unit = source == 0 ? params_.velocity_unit : 1.0;
    const std::size_t count = message.name.size();
    JointSample sample{*stamp, message.name, message.position, message.velocity, message.effort};
    if (sample.velocities.empty()) sample.velocities.assign(count, 0.0);
    if (sample.efforts.empty()) sample.efforts.assign(count, 0.0);
    for (double& velocity : sample.velocities) velocity *= unit;
    const JointStateJoiner::Added added = joiner_.add(source, sample);
    if (!added.refusal.empty()) inputs_.drop(topic, added.refusal);
    if (added.tick) publish(*added.tick);
  }

  void fill() {
    if (const auto tick = joiner_.tick_at(prf_ros::to_core(ros::Time::now()))) publish(*tick);
  }

  void publish(const JointSample& tick) {
    sensor_msgs::JointState message;
    message.header.stamp = prf_ros::to_ros_time(tick.stamp);
    message.name = tick.names;
    message.position = tick.positions;
    message.velocity = tick.velocities;
    message.effort = tick.efforts;
    joint_states_.publish(message);
    lacking_ = std::count_if(params_.driver.joints.begin(), params_.driver.joints.end(),
                             [&tick](const std::string& joint) {
                               return std::count(tick.names.begin(), tick.names.end(), joint) == 0;
                             });
    ++ticks_;
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& out) {
    using Level = diagnostic_msgs::DiagnosticStatus;
    if (ticks_ == 0) {
      out.summary(Level::ERROR, "no tick: nothing usable on " + params_.driver.state_topic);
    } else if (lacking_ > 0) {
      out.summary(Level::ERROR, params_.driver.state_topic + " lacks joints of driver/joints");
    } else {
      out.summary(Level::OK, "joins the joint states");
    }
    inputs_.report(out);
    out.add("ticks", ticks_);
    out.add("joints of the arm that are not in the ticks", lacking_);
  }

  JoinerNodeParams params_;
  JointStateJoiner joiner_;
  ros::Publisher joint_states_;
  diagnostic_updater::Updater diagnostics_;
  prf_ros::InputMonitor inputs_;
  ros::Timer timer_;
  unsigned long ticks_ = 0;
  std::ptrdiff_t lacking_ = 0;
};

}  // namespace
}  // namespace prf_drivers

int main(int argc, char** argv) {
  ros::init(argc, argv, "joint_state_joiner");
  ros::NodeHandle node;
  return prf_ros::run([&node] {
    prf_drivers::JoinerNode joiner(node, prf_drivers::load_joiner(node, ros::NodeHandle("~")));
    ros::spin();
  });
}
