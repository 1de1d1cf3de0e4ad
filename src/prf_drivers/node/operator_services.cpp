// SPDX-License-Identifier: BSD-3-Clause
#include "operator_services.hpp"

#include <ros/console.h>
#include <ros/service.h>
#include <ros/steady_timer.h>
#include <std_msgs/Int8.h>

#include <prf_core/quoted.hpp>
#include <prf_ros/driver_messages.hpp>
#include <utility>

namespace prf_drivers {
namespace {

constexpr std::uint32_t kQueue = 10;

double now() { return ros::SteadyTime::now().toSec(); }

template <typename Request, typename Response>
bool call(const std::string& name) {
  Request request;
  Response response;
  return ros::service::call(name, request, response);
}

}  // namespace

OperatorServices::OperatorServices(prf_ros::InputMonitor& inputs, const AdapterNodeParams& params,
                                   std::function<void()> changed, std::function<void()> reset)
    : driver_(params.driver),
      gate_(params.operators),
      changed_(std::move(changed)),
      reset_(std::move(reset)) {
  ros::NodeHandle node("~");
  // The switch has no stamp: what counts is when it comes.
  const auto presence =
      params.operators.dead_man ? prf_ros::Presence::kContinuous : prf_ros::Presence::kOnDemand;
  inputs.subscribe<std_msgs::Bool>({node.resolveName("enable"), "std_msgs/Bool", 0.0, presence},
                                   kQueue, [this](const std_msgs::BoolConstPtr& message) {
                                     gate_.enable(message->data != 0, now());
                                     changed_();
                                   });
  inputs.subscribe<std_msgs::String>(
      {node.resolveName("check"), "std_msgs/String, empty when nothing is red", 0.0,
       prf_ros::Presence::kOnDemand},
      kQueue, [this](const std_msgs::StringConstPtr& message) {
        gate_.checked(message->data.empty() ? "" : prf_core::quoted(message->data));
        changed_();
      });
  const std::string speed = node.resolveName("speed");
  inputs.subscribe<std_msgs::Float64>(
      {speed, "std_msgs/Float64, 0 to 1", 0.0, prf_ros::Presence::kOnDemand}, kQueue,
      [this, &inputs, speed](const std_msgs::Float64ConstPtr& message) {
        if (message->data >= 0.0 && message->data <= 1.0) {
          speed_ = message->data;
          changed_();
        } else {
          inputs.drop(speed, "not within 0 to 1");
        }
      });
  status_ = node.advertise<std_msgs::Int8>("status", kQueue, true);
  services_ = {node.advertiseService("stop", &OperatorServices::on_stop, this),
               node.advertiseService("reset", &OperatorServices::on_reset, this),
               node.advertiseService("hold", &OperatorServices::on_hold, this)};
}

std::string OperatorServices::veto() const { return gate_.veto(now()); }

void OperatorServices::tell(MotionCode code) {
  if (code == told_) return;
  told_ = code;
  std_msgs::Int8 message;
  message.data = static_cast<std::int8_t>(code);
  status_.publish(message);
}

std::string OperatorServices::call_driver(bool stop) const {
  const std::string& name = stop ? driver_.stop_service : driver_.start_service;
  if (name.empty()) return "the driver has no service for it, its power stays as it is";
  const bool is_kinova = driver_.speaks == Speaks::kKinova;
  const bool done =
      is_kinova && stop ? call<prf_ros::kinova::StopRequest, prf_ros::kinova::StopResponse>(name)
      : is_kinova       ? call<prf_ros::kinova::StartRequest, prf_ros::kinova::StartResponse>(name)
                        : call<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(name);
  return done
             ? name + " called"
             : name +
                   " FAILED: it is not offered or refused; use the emergency stop if the arm moves";
}

// The arm is held first: the driver's service may take its time, or not be there.
bool OperatorServices::on_stop(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  gate_.stop();
  changed_();
  response.message = "the arm is held; " + call_driver(true);
  response.success = 1;
  ROS_WARN("stop: %s", response.message.c_str());
  return true;
}

bool OperatorServices::on_reset(std_srvs::Trigger::Request&,
                                std_srvs::Trigger::Response& response) {
  gate_.reset();
  reset_();
  response.message = call_driver(false);
  changed_();
  response.success = 1;
  ROS_WARN("reset: %s", response.message.c_str());
  return true;
}

bool OperatorServices::on_hold(std_srvs::SetBool::Request& request,
                               std_srvs::SetBool::Response& response) {
  gate_.hold(request.data != 0);
  changed_();
  response.success = 1;
  response.message = request.data != 0 ? "the arm is held" : "the hold is off";
  return true;
}

}  // namespace prf_drivers
