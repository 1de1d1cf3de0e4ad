// SPDX-License-Identifier: BSD-3-Clause
// The action execute_skill. A goal begins one execution with the next tick that is processed. One
// goal at a time: others are rejected with the reason. A goal that names a demonstration is pending
// until the planner has accepted or refused that.
//
// A cancelled goal stops the execution at the next tick; the arm brakes within its limits, and the
// goal is PREEMPTED once the arm stands, at the latest kMaxBraking of data time later.
#pragma once

#include <actionlib/server/action_server.h>
#include <prf_msgs/ExecuteSkillAction.h>
#include <sensor_msgs/JointState.h>

#include <optional>
#include <string>

#include "params.hpp"
#include "prf_decision/skill_executive.hpp"

namespace prf_decision {

class SkillAction {
 public:
  SkillAction(const ros::NodeHandle& node, const Robot& robot, SkillExecutive& executive);

  // Once all else of the node is ready.
  void start() { server_.start(); }

  void see_joints(const sensor_msgs::JointState& joints);
  void update(const Progress& progress);  // after every tick
  void end_run();                         // the data's clock went back
  // Feedback while no tick comes: what is missing.
  void tell_missing(const std::string& what);

 private:
  using Server = actionlib::ActionServer<prf_msgs::ExecuteSkillAction>;
  using Result = prf_msgs::ExecuteSkillResult;

  // The goal that was not rejected, until it has its result.
  struct Current {
    Server::GoalHandle handle;
    bool pending = false;  // until the planner has answered
    std::optional<Progress> stopped;
    std::optional<Stamp> feedback_given;
    ExecutionState feedback_state = ExecutionState::kWaiting;
    double feedback_cursor = 0;
  };

  void on_goal(Server::GoalHandle goal);
  void on_cancel(Server::GoalHandle goal);
  [[nodiscard]] std::string refusal(const prf_msgs::ExecuteSkillGoal& goal) const;
  void decide_pending(const Progress& progress);
  void give_feedback(const Progress& progress);
  void give_up(const Progress& progress);

  Robot robot_;
  SkillExecutive& executive_;
  bool arm_moves_ = false;
  std::optional<Current> goal_;
  Server server_;
};

}  // namespace prf_decision
