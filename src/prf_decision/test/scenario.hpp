// SPDX-License-Identifier: BSD-3-Clause
// Small worlds for the tests: a straight skill, a target that moves as told, usual parameters.
#pragma once

#include <jaco_kinematics/jaco_arm.hpp>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <memory>

#include "prf_decision/skill_executive.hpp"

namespace prf_decision {

inline constexpr Duration kTickPeriod = std::chrono::milliseconds(10);

inline Pose pose_at(double x, double y, double z) { return {{x, y, z}, {1, 0, 0, 0}}; }

// From (0.3, 0, 0.5) to (0.6, 0, 0.5) in 11 nodes and 1 s; the target's frame is 0.4 m ahead.
inline Trajectory straight_skill() {
  Trajectory skill;
  for (int i = 0; i <= 10; ++i) {
    skill.poses.push_back(pose_at(0.3 + 0.03 * i, 0, 0.5));
    skill.times.push_back(std::chrono::milliseconds(100 * i));
  }
  skill.goal_in_target = pose_at(-0.4, 0, 0);
  return skill;
}

inline TargetForecast forecast_of(Stamp stamp, const Eigen::Vector3d& position,
                                  const Eigen::Vector3d& velocity,
                                  TargetStatus status = TargetStatus::kTracking) {
  TargetForecast forecast;
  forecast.stamp = stamp;
  forecast.status = status;
  for (const double horizon : {0.0, 0.1, 0.5}) {
    prf_core::TargetPrediction prediction;
    prediction.horizon = from_seconds(horizon);
    prediction.target.pose.position = position + velocity * horizon;
    prediction.target.linear_velocity = velocity;
    forecast.predictions.push_back(prediction);
  }
  return forecast;
}

inline HmmParams usual_hmm() {
  HmmParams hmm;
  hmm.initial << 0.8, 0.15, 0.05;
  hmm.transition << 0.97, 0.03, 0, 0.015, 0.97, 0.015, 0, 0.03, 0.97;
  const std::array<double, kIntents> sigma{0.10, 0.19, 0.36};
  for (std::size_t i = 0; i < kIntents; ++i) {
    hmm.mean[i].setZero();
    hmm.covariance[i] = Eigen::Matrix3d::Identity() * sigma[i] * sigma[i];
  }
  return hmm;
}

// A model without symmetries: correlated axes, means that differ, every transition possible.
inline HmmParams skewed_hmm() {
  HmmParams hmm;
  hmm.initial << 0.5, 0.3, 0.2;
  hmm.transition << 0.7, 0.2, 0.1, 0.25, 0.6, 0.15, 0.05, 0.35, 0.6;
  hmm.mean = {Eigen::Vector3d{0.01, 0, -0.02}, Eigen::Vector3d{0.1, 0.05, 0},
              Eigen::Vector3d{-0.2, 0.1, 0.3}};
  hmm.covariance[0] << 0.02, 0.004, 0, 0.004, 0.01, 0.001, 0, 0.001, 0.015;
  hmm.covariance[1] << 0.05, -0.01, 0.02, -0.01, 0.08, 0, 0.02, 0, 0.06;
  hmm.covariance[2] << 0.2, 0.05, 0.03, 0.05, 0.3, -0.04, 0.03, -0.04, 0.25;
  return hmm;
}

inline prf_control::Arm jaco() {
  static const prf_control::Arm arm = std::make_shared<jaco_kinematics::JacoArm>();
  return arm;
}

inline GuardParams usual_guards() {
  GuardParams guards;
  guards.max_gap = from_seconds(0.3);
  guards.pause_after = from_seconds(0.3);
  guards.reverse_after = from_seconds(1.0);
  guards.stop_after = from_seconds(2.0);
  guards.shoulder = {0, 0, 0.2755};
  guards.max_reach = 0.95;
  guards.workspace_radius = 2.0;
  guards.max_target_speed = 1.5;
  guards.clearance = 0.04;
  guards.arm = jaco();
  guards.following.path = {0.10, 0.35};
  guards.following.goal = {0.05, 0.20};
  guards.following.limits = {from_seconds(0.1), from_seconds(1.0), from_seconds(5.0)};
  return guards;
}

inline DecisionParams usual_params() {
  DecisionParams parameters;
  parameters.reference.lead = from_seconds(0.02);
  parameters.hold_time = from_seconds(1.0);
  parameters.dwell_time = from_seconds(0.2);
  parameters.time_limit = from_seconds(20.0);
  parameters.reference.tracking_tolerance = 0.02;
  parameters.reference.catch_up = {0.2, 0.5, 0.1};
  parameters.guards = usual_guards();
  parameters.hmm = usual_hmm();
  parameters.arm = {0.95, 4.0, jaco()};
  parameters.search = {Duration{0}, 0.4, 1.2, jaco()};
  return parameters;
}

}  // namespace prf_decision
