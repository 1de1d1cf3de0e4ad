// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/guards.hpp"

#include <cmath>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <prf_core/require.hpp>

#include "text.hpp"

namespace prf_decision {

using prf_core::require;

void GuardParams::validate() const {
  prf_core::require_positive("coast_limits[0]", to_seconds(pause_after), "s");
  require(reverse_after > pause_after, "coast_limits[1]", to_seconds(reverse_after),
          "> coast_limits[0] = " + std::to_string(to_seconds(pause_after)) + " s");
  require(stop_after > reverse_after, "coast_limits[2]", to_seconds(stop_after),
          "> coast_limits[1] = " + std::to_string(to_seconds(reverse_after)) + " s");
  require(shoulder.allFinite(), "shoulder", shoulder.transpose(), "finite");
  for (const auto& [name, value] :
       {std::pair("max_reach", max_reach), std::pair("workspace_radius", workspace_radius),
        std::pair("max_target_speed", max_target_speed)}) {
    require(value > 0 && std::isfinite(value), name, value, "> 0 and finite");
  }
}

std::optional<Objection> object_to_age(const GuardParams& guards, Duration age) {
  const auto unseen = [&](Event event, Duration limit) {
    return Objection{event, sentence("target unseen for ", to_seconds(age), " s, limit ",
                                     to_seconds(limit), " s")};
  };
  if (age > guards.stop_after) return unseen(Event::kLost, guards.stop_after);
  if (age > guards.reverse_after) return unseen(Event::kOverdue, guards.reverse_after);
  if (age > guards.pause_after) return unseen(Event::kHazard, guards.pause_after);
  return std::nullopt;
}

std::optional<Objection> object_to_forecast(const GuardParams& guards,
                                            const TargetForecast& forecast) {
  for (const auto& [horizon, target, covariance] : forecast.predictions) {
    const double distance = (target.pose.position - guards.shoulder).norm();
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

std::optional<Objection> object_to_goal(const GuardParams& guards, const Pose& hand_goal) {
  const double distance = (hand_goal.position - guards.shoulder).norm();
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
