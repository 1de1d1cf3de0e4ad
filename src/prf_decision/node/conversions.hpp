// SPDX-License-Identifier: BSD-3-Clause
// Messages to core types and back. Messages that must not be acted on throw std::invalid_argument.
#pragma once

#include <prf_msgs/ControlStatus.h>
#include <prf_msgs/ExecutionProgress.h>
#include <prf_msgs/SkillTrajectory.h>
#include <prf_msgs/TargetForecast.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <memory>
#include <optional>
#include <string>

#include "params.hpp"
#include "prf_decision/skill_executive.hpp"

namespace prf_decision {

// Counted from base to hand; none for a finger or a leg.
[[nodiscard]] std::optional<int> arm_joint(const Robot& robot, const std::string& name);

// The joints of the arm that a message lacks, as "j1, j2"; empty: it has them all.
[[nodiscard]] std::string missing_joints(const Robot& robot, const sensor_msgs::JointState& joints);
// The arm's joints, rad; none when one is missing, not finite or absurd.
[[nodiscard]] std::optional<arm_kinematics::JointVector> measured_joints(
    const Robot& robot, const sensor_msgs::JointState& joints);

[[nodiscard]] ControlReport to_core(const prf_msgs::ControlStatus& message);

[[nodiscard]] std::shared_ptr<const TargetForecast> to_core(
    const Robot& robot, const prf_msgs::TargetForecast& message);
[[nodiscard]] bool has_plan(const prf_msgs::SkillTrajectory& message);
// A plan that must not be executed becomes none, with the reason.
[[nodiscard]] PlanResult to_plan_result(const Robot& robot,
                                        const prf_msgs::SkillTrajectory& message);

[[nodiscard]] prf_msgs::ExecutionProgress to_message(const Robot& robot, const Progress& progress);
[[nodiscard]] trajectory_msgs::MultiDOFJointTrajectory to_message(
    const Robot& robot, Stamp stamp, const std::optional<MovingPose>& setpoint);

}  // namespace prf_decision
