// SPDX-License-Identifier: BSD-3-Clause
#include "conversions.hpp"

#include <algorithm>
#include <prf_core/require.hpp>
#include <prf_ros/conversions.hpp>

namespace prf_decision {
namespace {

void require_frame(const std::string& frame_id, const std::string& wanted) {
  prf_core::require(frame_id == wanted, "frame_id", frame_id, wanted);
}

geometry_msgs::Transform to_transform(const Pose& pose) {
  geometry_msgs::Transform transform;
  transform.translation = prf_ros::to_vector3(pose.position);
  transform.rotation = prf_ros::to_message(pose.orientation);
  return transform;
}

std::shared_ptr<const Trajectory> to_core(const Robot& robot,
                                          const prf_msgs::SkillTrajectory& message) {
  require_frame(message.header.frame_id, robot.base_link);
  auto trajectory = std::make_shared<Trajectory>();
  for (const auto& pose : message.poses) trajectory->poses.push_back(prf_ros::to_core(pose));
  for (const auto& time : message.time_from_start) {
    trajectory->times.push_back(prf_ros::to_core(time));
  }
  trajectory->goal_in_target = prf_ros::to_core(message.goal_in_target);
  trajectory->validate();
  return trajectory;
}

}  // namespace

std::optional<int> arm_joint(const Robot& robot, const std::string& name) {
  const auto found = std::find(robot.joints.begin(), robot.joints.end(), name);
  if (found == robot.joints.end()) return std::nullopt;
  return static_cast<int>(found - robot.joints.begin());
}

std::string missing_joints(const Robot& robot, const sensor_msgs::JointState& joints) {
  std::string missing;
  for (const std::string& name : robot.joints) {
    const auto found = std::find(joints.name.begin(), joints.name.end(), name);
    const auto index = static_cast<std::size_t>(std::distance(joints.name.begin(), found));
    if (index < joints.position.size()) continue;
    missing += (missing.empty() ? "" : ", ") + name;
  }
  return missing;
}

std::optional<arm_kinematics::JointVector> measured_joints(const Robot& robot,
                                                           const sensor_msgs::JointState& joints) {
  constexpr double kMostTurns = 100;  // rad; beyond it the angle's sine means nothing
  if (!missing_joints(robot, joints).empty()) return std::nullopt;
  arm_kinematics::JointVector q(static_cast<Eigen::Index>(robot.joints.size()));
  for (std::size_t i = 0; i < std::min(joints.name.size(), joints.position.size()); ++i) {
    if (const auto joint = arm_joint(robot, joints.name[i])) q[*joint] = joints.position[i];
  }
  if (!(q.cwiseAbs().maxCoeff() <= kMostTurns) || !q.allFinite()) return std::nullopt;
  return q;
}

ControlReport to_core(const prf_msgs::ControlStatus& message) {
  using prf_msgs::ControlStatus;
  ControlReport report;
  report.stamp = prf_ros::to_core(message.header.stamp);
  // What follows as far as it can is judged by the following error. An unknown code is a failure.
  report.failing =
      message.code != ControlStatus::FOLLOWING && message.code != ControlStatus::HOLDING &&
      message.code != ControlStatus::LIMITED && message.code != ControlStatus::UNREACHABLE;
  report.reason = message.reason.substr(0, 200);
  return report;
}

std::shared_ptr<const TargetForecast> to_core(const Robot& robot,
                                              const prf_msgs::TargetForecast& message) {
  require_frame(message.header.frame_id, robot.base_link);
  return std::make_shared<TargetForecast>(prf_ros::to_core(message));
}

bool has_plan(const prf_msgs::SkillTrajectory& message) {
  using prf_msgs::SkillTrajectory;
  return message.status != SkillTrajectory::REFUSED && message.status != SkillTrajectory::NO_PLAN;
}

PlanResult to_plan_result(const Robot& robot, const prf_msgs::SkillTrajectory& message) {
  PlanResult result;
  result.stamp = prf_ros::to_core(message.header.stamp);
  result.demonstration_switch = message.demonstration_switch;
  result.refused = message.status == prf_msgs::SkillTrajectory::REFUSED;
  if (!has_plan(message)) {
    result.message = message.message;
    return result;
  }
  try {
    result.plan = to_core(robot, message);
  } catch (const std::invalid_argument& error) {
    result.message = error.what();
  }
  return result;
}

prf_msgs::ExecutionProgress to_message(const Robot& robot, const Progress& progress) {
  prf_msgs::ExecutionProgress message;
  message.header.stamp = prf_ros::to_ros_time(progress.stamp);
  message.header.frame_id = robot.base_link;
  message.forecast_stamp = prf_ros::to_ros_time(progress.forecast_stamp);
  message.state = static_cast<std::uint8_t>(progress.state);
  message.reason = progress.reason;
  for (Eigen::Index i = 0; i < 3; ++i) {
    message.posterior[static_cast<std::size_t>(i)] = progress.posterior[i];
  }
  message.cursor = progress.cursor;
  message.frozen = static_cast<std::uint32_t>(progress.frozen);
  message.time_to_go = prf_ros::to_ros_duration(progress.time_to_go);
  message.demonstration = progress.demonstration.name;
  message.demonstration_switch = progress.demonstration.number;
  message.following_error = progress.following ? progress.following->position : -1;
  message.following_rotation = progress.following ? progress.following->rotation : -1;
  message.holdable = progress.holdable.value_or(-1);
  return message;
}
static_assert(static_cast<int>(ExecutionState::kWaiting) == prf_msgs::ExecutionProgress::WAITING);
static_assert(static_cast<int>(ExecutionState::kForward) == prf_msgs::ExecutionProgress::FORWARD);
static_assert(static_cast<int>(ExecutionState::kPause) == prf_msgs::ExecutionProgress::PAUSE);
static_assert(static_cast<int>(ExecutionState::kReverse) == prf_msgs::ExecutionProgress::REVERSE);
static_assert(static_cast<int>(ExecutionState::kTracking) == prf_msgs::ExecutionProgress::TRACKING);
static_assert(static_cast<int>(ExecutionState::kRetract) == prf_msgs::ExecutionProgress::RETRACT);
static_assert(static_cast<int>(ExecutionState::kDone) == prf_msgs::ExecutionProgress::DONE);
static_assert(static_cast<int>(ExecutionState::kStopped) == prf_msgs::ExecutionProgress::STOPPED);
static_assert(static_cast<int>(ExecutionState::kSearch) == prf_msgs::ExecutionProgress::SEARCH);

trajectory_msgs::MultiDOFJointTrajectory to_message(const Robot& robot, Stamp stamp,
                                                    const std::optional<MovingPose>& setpoint) {
  trajectory_msgs::MultiDOFJointTrajectory message;
  message.header.stamp = prf_ros::to_ros_time(stamp);
  message.header.frame_id = robot.base_link;
  message.joint_names = {robot.tip_link};
  if (!setpoint) return message;
  message.points.resize(1);
  message.points[0].transforms.push_back(to_transform(setpoint->pose));
  message.points[0].velocities.push_back(
      prf_ros::to_twist(setpoint->linear_velocity, setpoint->angular_velocity));
  return message;
}

}  // namespace prf_decision
