// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/lockstep.hpp"

#include <prf_msgs/topics.h>

#include <algorithm>
#include <array>

namespace platform_sim {
namespace {

// The responses without which the simulator does not advance.
constexpr std::array kAwaited = {Response::kWrench, Response::kProgress, Response::kCommand,
                                 Response::kDriver};

}  // namespace

const char* topic_name(Response response) {
  switch (response) {
    case Response::kDetections:
      return prf_msgs::topics::kTagDetections;
    case Response::kForecast:
      return prf_msgs::topics::kTargetForecast;
    case Response::kProgress:
      return prf_msgs::topics::kExecutionProgress;
    case Response::kTrajectory:
      return prf_msgs::topics::kSkillTrajectory;
    case Response::kSetpoint:
      return prf_msgs::topics::kExecutionSetpoint;
    case Response::kCommand:
      return prf_msgs::topics::kJointCommand;
    case Response::kDriver:
      return "the driver's command";
    case Response::kWrench:
      return prf_msgs::topics::kGuideWrench;
  }
  return "";
}

void Lockstep::published(prf_core::Stamp stamp) {
  newest_ = std::max(stamp, newest_.value_or(stamp));
}

bool Lockstep::is_ahead(prf_core::Stamp stamp) const { return !newest_ || stamp > *newest_; }

void Lockstep::published_image(prf_core::Stamp exposure) {
  published(exposure);
  expect(Response::kDetections, exposure);
}

void Lockstep::published_joint_states(prf_core::Stamp tick) {
  published(tick);
  expect(Response::kWrench, tick);
  expect(Response::kProgress, tick);
  expect(Response::kSetpoint, tick);
  expect(Response::kCommand, tick);
  if (with_driver_) expect(Response::kDriver, tick);
}

Receipt Lockstep::received(Response response, prf_core::Stamp stamp) {
  if (is_ahead(stamp)) return Receipt::kAhead;
  Expected& from = expected(response);
  if (from.last_received && stamp <= *from.last_received) return Receipt::kNotNewer;
  from.last_received = stamp;
  from.given_up = false;
  while (!from.pending.empty() && from.pending.front() <= stamp) from.pending.pop_front();
  if (response == Response::kDetections) expect(Response::kForecast, stamp);
  return Receipt::kTaken;
}

Receipt Lockstep::received_progress(prf_core::Stamp stamp, prf_core::Stamp forecast_stamp) {
  const Receipt receipt = received(Response::kProgress, stamp);
  const bool names_a_forecast = forecast_stamp != prf_core::Stamp{0} && !is_ahead(forecast_stamp);
  if (receipt == Receipt::kTaken && names_a_forecast && forecast_stamp != forecast_in_force_) {
    forecast_in_force_ = forecast_stamp;
    expect(Response::kTrajectory, stamp);
  }
  return receipt;
}

bool Lockstep::is_waited_for(Response response) const {
  return !expected(response).pending.empty() && !expected(response).given_up;
}

bool Lockstep::is_complete() const {
  return std::none_of(kAwaited.begin(), kAwaited.end(),
                      [this](Response response) { return is_waited_for(response); });
}

std::vector<Response> Lockstep::go_on() {
  std::vector<Response> missing;
  for (const Response response : kAwaited) {
    if (!is_waited_for(response)) continue;
    expected(response).given_up = true;
    missing.push_back(response);
  }
  return missing;
}

void Lockstep::insist() {
  for (Expected& of : expected_) of.given_up = false;
}

bool Lockstep::goes_without() const {
  return std::any_of(expected_.begin(), expected_.end(),
                     [](const Expected& of) { return of.given_up; });
}

std::optional<SilentTopic> Lockstep::first_silent() const {
  std::optional<SilentTopic> silent;
  for (std::size_t i = 0; i < kResponseCount; ++i) {
    const std::deque<prf_core::Stamp>& pending = expected_[i].pending;
    if (pending.empty()) continue;
    if (!silent || pending.front() < silent->stamp) {
      silent = SilentTopic{static_cast<Response>(i), pending.front()};
    }
  }
  return silent;
}

void Lockstep::expect(Response response, prf_core::Stamp stamp) {
  const bool of_framework = response != Response::kWrench;
  if (of_framework != (peer_ == Peer::kFramework)) return;
  Expected& of = expected(response);
  if (of.last_received && stamp <= *of.last_received) return;
  if (of.pending.empty() || stamp > of.pending.back()) of.pending.push_back(stamp);
}

}  // namespace platform_sim
