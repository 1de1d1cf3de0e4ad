// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/lockstep.hpp"

namespace platform_sim {

const char* topic_name(Link link) {
  switch (link) {
    case Link::kDetections:
      return "tag_detections";
    case Link::kForecast:
      return "target/forecast";
    case Link::kProgress:
      return "execution/progress";
    case Link::kTrajectory:
      return "skill/trajectory";
    case Link::kSetpoint:
      return "execution/setpoint";
    case Link::kCommand:
      return "joint_command";
    case Link::kWrench:
      return "guide/wrench";
  }
  return "";
}

void Lockstep::published_image(StampNs exposure) { ask(Link::kDetections, exposure); }

void Lockstep::published_joint_states(StampNs tick) {
  ask(Link::kWrench, tick);
  ask(Link::kProgress, tick);
  ask(Link::kSetpoint, tick);
  ask(Link::kCommand, tick);
}

bool Lockstep::received(Link link, StampNs stamp) {
  Account& from = account(link);
  if (from.last_received && stamp <= *from.last_received) return false;
  from.last_received = stamp;
  while (!from.owed.empty() && from.owed.front() <= stamp) from.owed.pop_front();
  if (link == Link::kDetections) ask(Link::kForecast, stamp);
  return true;
}

bool Lockstep::received_progress(StampNs stamp, StampNs forecast_stamp) {
  if (!received(Link::kProgress, stamp)) return false;
  if (forecast_stamp != 0 && forecast_stamp != forecast_in_force_) {
    forecast_in_force_ = forecast_stamp;
    ask(Link::kTrajectory, stamp);
  }
  return true;
}

bool Lockstep::answered() const {
  return account(Link::kWrench).owed.empty() && account(Link::kProgress).owed.empty() &&
         account(Link::kCommand).owed.empty();
}

std::optional<SilentTopic> Lockstep::first_silent() const {
  std::optional<SilentTopic> silent;
  for (std::size_t i = 0; i < kLinkCount; ++i) {
    const std::deque<StampNs>& owed = accounts_[i].owed;
    if (owed.empty()) continue;
    if (!silent || owed.front() < silent->stamp) {
      silent = SilentTopic{static_cast<Link>(i), owed.front()};
    }
  }
  return silent;
}

void Lockstep::ask(Link link, StampNs stamp) {
  const bool of_framework = link != Link::kWrench;
  if (of_framework != (peer_ == Peer::kFramework)) return;
  Account& of = account(link);
  if (of.last_received && stamp <= *of.last_received) return;
  if (of.owed.empty() || stamp > of.owed.back()) of.owed.push_back(stamp);
}

}  // namespace platform_sim
