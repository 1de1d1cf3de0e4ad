// SPDX-License-Identifier: BSD-3-Clause
// Subscribes a node to its topics and watches them: silence, rate, a second publisher, dropped
// messages. It logs what is wrong together with what is expected, and adds it to the node's
// diagnostics. It never changes, delays or drops a message.
//
//   diagnostic_updater::Updater diagnostics_;
//   prf_ros::InputMonitor inputs_{node_, &diagnostics_};
//
//   inputs_.subscribe<sensor_msgs::JointState>(
//       {"joint_states", "sensor_msgs/JointState with joint_1 ... joint_7", 100.0}, 1000,
//       [this](const sensor_msgs::JointStateConstPtr& message) { on_joint_states(*message); });
//
//   inputs_.drop("joint_states", "joint_3 is missing");  // in the callback: counted, logged
//
//   void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
//     status.summary(...);      // what the node itself has to say
//     inputs_.report(status);   // the worst of both
//   }
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prf_ros/input_health.hpp"

namespace prf_ros {

class InputMonitor {
 public:
  // Once a second of wall time the inputs are checked and `updater` is updated, at once when
  // something is wrong: so diagnostics come also when no message does. It must outlive this.
  InputMonitor(const ros::NodeHandle& node, diagnostic_updater::Updater* updater);
  InputMonitor(const InputMonitor&) = delete;
  InputMonitor& operator=(const InputMonitor&) = delete;

  template <typename Message>
  void subscribe(const InputExpectation& expected, std::uint32_t queue,
                 const std::function<void(const boost::shared_ptr<const Message>&)>& callback) {
    subscribe_events<Message>(expected, queue,
                              [callback](const ros::MessageEvent<const Message>& event) {
                                callback(event.getConstMessage());
                              });
  }

  // The same for a node that wants to know who has sent a message.
  template <typename Message>
  void subscribe_events(
      const InputExpectation& expected, std::uint32_t queue,
      const std::function<void(const ros::MessageEvent<const Message>&)>& callback) {
    using Event = ros::MessageEvent<const Message>;
    InputHealth& health = add(expected);
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const Event&>(
        expected.topic, queue, [this, &health, callback](const Event& event) {
          note(health, event.getConnectionHeaderPtr(), stamp_of(*event.getConstMessage()));
          callback(event);
        });
    options.transport_hints.tcpNoDelay();
    subscribers_.push_back(node_.subscribe(options));
  }

  // The message of `topic` that is being processed is not used. Text of foreign messages in
  // `reason` must be quoted; numbers that differ each time belong to the end of a log line of the
  // node's own, because drops are counted by reason.
  void drop(const std::string& topic, const std::string& reason);

  [[nodiscard]] const std::vector<ros::Subscriber>& subscribers() const { return subscribers_; }

  // Merges what is wrong with the inputs into the node's status, and adds counts and rates.
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  struct Input {
    explicit Input(const InputExpectation& expected, double now) : health(expected, now) {}
    InputHealth health;
    double logged = -1e9;  // wall time of the last line that the check wrote
  };

  template <typename Message>
  static std::optional<double> stamp_of(const Message& message) {
    const ros::Time* stamp = ros::message_traits::timeStamp(message);
    if (stamp == nullptr || stamp->isZero()) return std::nullopt;
    return stamp->toSec();
  }

  InputHealth& add(const InputExpectation& expected);
  void note(InputHealth& health, const boost::shared_ptr<ros::M_string>& connection,
            std::optional<double> stamp);
  void check();

  ros::NodeHandle node_;
  diagnostic_updater::Updater* updater_;
  std::deque<Input> inputs_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace prf_ros
