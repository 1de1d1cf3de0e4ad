// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/guards.hpp"

#include <jaco_kinematics/jaco_kinematics.hpp>
#include <stdexcept>

#include "text.hpp"

namespace prf_decision {
namespace {

void require(bool holds, const std::string& name, double value, const std::string& bound) {
  if (!holds) {
    throw std::invalid_argument(name + " is " + std::to_string(value) + ", must be " + bound);
  }
}

void require_positive(double value, const std::string& name) {
  require(value > 0 && std::isfinite(value), name, value, "> 0");
}

}  // namespace

void GuardParameters::validate() const {
  require_positive(to_seconds(pause_after), "coast_limits[0]");
  require(reverse_after > pause_after, "coast_limits[1]", to_seconds(reverse_after),
          "> coast_limits[0] = " + std::to_string(to_seconds(pause_after)));
  require(stop_after > reverse_after, "coast_limits[2]", to_seconds(stop_after),
          "> coast_limits[1] = " + std::to_string(to_seconds(reverse_after)));
  require_positive(max_reach, "max_reach");
  require_positive(workspace_radius, "workspace_radius");
  require_positive(max_target_speed, "max_target_speed");
}

std::optional<Objection> object_to_age(const GuardParameters& guards, Duration age) {
  const auto unseen = [&](Event event, Duration limit) {
    return Objection{event, sentence("target unseen for ", to_seconds(age), " s, limit ",
                                     to_seconds(limit), " s")};
  };
  if (age > guards.stop_after) return unseen(Event::kLost, guards.stop_after);
  if (age > guards.reverse_after) return unseen(Event::kOverdue, guards.reverse_after);
  if (age > guards.pause_after) return unseen(Event::kHazard, guards.pause_after);
  return std::nullopt;
}

std::optional<Objection> object_to_forecast(const GuardParameters& guards,
                                            const Forecast& forecast) {
  for (const auto& [horizon, target] : forecast.predictions) {
    const double distance = (target.pose.position - kShoulder).norm();
    if (distance > guards.workspace_radius) {
      return Objection{Event::kHazard,
                       sentence("forecast ", distance, " m from the shoulder in ",
                                to_seconds(horizon), " s, limit ", guards.workspace_radius, " m")};
    }
    const double speed = target.linear_velocity.norm();
    if (speed > guards.max_target_speed) {
      return Objection{Event::kHazard,
                       sentence("forecast speed ", speed, " m/s in ", to_seconds(horizon),
                                " s, limit ", guards.max_target_speed, " m/s")};
    }
  }
  return std::nullopt;
}

std::optional<Objection> object_to_goal(const GuardParameters& guards, const Pose& hand_goal) {
  const double distance = (hand_goal.position - kShoulder).norm();
  if (distance > guards.max_reach) {
    return Objection{Event::kHazard, sentence("goal ", distance, " m from the shoulder, reach ",
                                              guards.max_reach, " m")};
  }
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(hand_goal.position) * hand_goal.orientation.normalized();
  if (jaco_kinematics::any_inverse(pose).status == jaco_kinematics::IkStatus::kSolved) {
    return std::nullopt;
  }
  return Objection{Event::kHazard, "no joint position within limits gives the goal"};
}

}  // namespace prf_decision
