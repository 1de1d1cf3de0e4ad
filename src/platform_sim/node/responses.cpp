// SPDX-License-Identifier: BSD-3-Clause
#include "responses.hpp"

#include <ros/console.h>

#include <boost/function.hpp>
#include <stdexcept>
#include <utility>

namespace platform_sim {
namespace {

constexpr std::uint32_t kQueueSize = 100;

}  // namespace

// A response may be silent: in real time nobody need be there, in lockstep the simulator tells.
prf_ros::InputExpectation expectation(Response response, const std::string& what) {
  return {topic_name(response), what, 0.0, prf_ros::Presence::kOnDemand};
}

template <class Message>
void Responses::listen(Response response, const std::string& what,
                       void (Responses::*receive)(const Message&)) {
  inputs_.subscribe<Message>(expectation(response, what), kQueueSize,
                             [this, receive](const boost::shared_ptr<const Message>& message) {
                               (this->*receive)(*message);
                             });
}

template <class Message>
void Responses::note(Response response, const std::string& what) {
  inputs_.subscribe<Message>(expectation(response, what), kQueueSize,
                             [this, response](const boost::shared_ptr<const Message>& message) {
                               take(response, message->header.stamp);
                             });
}

Responses::Responses(ros::NodeHandle& node, Peer peer, bool with_driver,
                     const std::vector<std::string>& joints)
    : joints_(joints), lockstep_(peer, with_driver), inputs_(node, &updater_) {
  updater_.setHardwareID("none");
  updater_.add("responses", this, &Responses::diagnose);
  if (peer == Peer::kGuide) {
    listen(Response::kWrench, "geometry_msgs/WrenchStamped in world", &Responses::receive_wrench);
    return;
  }
  note<prf_msgs::TagDetectionArray>(Response::kDetections, "prf_msgs/TagDetectionArray");
  note<prf_msgs::TargetForecast>(Response::kForecast, "prf_msgs/TargetForecast");
  listen(Response::kProgress, "prf_msgs/ExecutionProgress", &Responses::receive_progress);
  note<prf_msgs::SkillTrajectory>(Response::kTrajectory, "prf_msgs/SkillTrajectory");
  note<trajectory_msgs::MultiDOFJointTrajectory>(Response::kSetpoint,
                                                 "trajectory_msgs/MultiDOFJointTrajectory");
  if (with_driver) {
    note<trajectory_msgs::JointTrajectory>(Response::kCommand, "trajectory_msgs/JointTrajectory");
    return;
  }
  listen(Response::kCommand,
         "trajectory_msgs/JointTrajectory with " + joints_.front() + " ... " + joints_.back(),
         &Responses::receive_command);
}

std::optional<ArmCommand> Responses::take_command() {
  return std::exchange(command_, std::nullopt);
}

std::optional<HandWrench> Responses::take_wrench() { return std::exchange(wrench_, std::nullopt); }

std::vector<std::string> Responses::without_publisher() const {
  std::vector<std::string> names;
  for (const ros::Subscriber& subscriber : inputs_.subscribers()) {
    if (subscriber.getNumPublishers() == 0) names.push_back(subscriber.getTopic());
  }
  return names;
}

unsigned Responses::publishers() const {
  unsigned count = 0;
  for (const ros::Subscriber& subscriber : inputs_.subscribers())
    count += subscriber.getNumPublishers();
  return count;
}

void Responses::receive_progress(const prf_msgs::ExecutionProgress& message) {
  if (!take(Response::kProgress, message.header.stamp, message.forecast_stamp)) return;
  finished_ = finished_ || message.state == prf_msgs::ExecutionProgress::DONE ||
              message.state == prf_msgs::ExecutionProgress::STOPPED;
}

void Responses::receive_command(const trajectory_msgs::JointTrajectory& message) {
  if (!take(Response::kCommand, message.header.stamp)) return;
  command_.reset();
  try {
    command_ = to_arm_command(message, joints_);
  } catch (const std::invalid_argument& error) {
    refuse(Response::kCommand, error.what());
  }
}

void Responses::receive_wrench(const geometry_msgs::WrenchStamped& message) {
  if (!take(Response::kWrench, message.header.stamp)) return;
  wrench_ = HandWrench{};
  try {
    wrench_ = to_hand_wrench(message);
  } catch (const std::invalid_argument& error) {
    refuse(Response::kWrench, error.what());
  }
}

bool Responses::take(Response response, const ros::Time& stamp, const ros::Time& forecast_stamp) {
  const prf_core::Stamp received = prf_ros::to_core(stamp);
  const Receipt receipt =
      response == Response::kProgress
          ? lockstep_.received_progress(received, prf_ros::to_core(forecast_stamp))
          : lockstep_.received(response, received);
  if (receipt == Receipt::kNotNewer) {
    inputs_.drop(topic_name(response), "it is late or has come before");
  } else if (receipt == Receipt::kAhead) {
    inputs_.drop(topic_name(response), "its stamp is ahead of everything published");
  }
  return receipt == Receipt::kTaken;
}

void Responses::refuse(Response response, const std::string& why) {
  ++refused_;
  inputs_.drop(topic_name(response), "it cannot be used");
  if (refusals_.is_due()) {
    ROS_WARN("%s refused, the arm holds: %s (%u so far)", topic_name(response), why.c_str(),
             refused_);
  }
}

void Responses::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "all responses are taken");
  status.add("refused", refused_);
  inputs_.report(status);
}

}  // namespace platform_sim
