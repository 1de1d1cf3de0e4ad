// SPDX-License-Identifier: BSD-3-Clause
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <prf_ros/private_parameters.hpp>

#include <chrono>

#include "conversions.hpp"
#include "elte_planner/followed_skill.hpp"
#include "elte_planner/request_queue.hpp"
#include "params.hpp"

namespace elte_planner {
namespace {

constexpr double kShapeLossWarning = 0.5;

class SkillPlannerNode {
 public:
  explicit SkillPlannerNode(const NodeParams& params)
      : frame_(params.frame),
        late_after_(params.late_after),
        weights_(params.session.weights),
        skill_(params.session, params.demonstration, params.frame) {
    warn_of_lost_shape();
    const auto hints = ros::TransportHints().tcpNoDelay();
    forecast_ =
        node_.subscribe("target/forecast", 100, &SkillPlannerNode::on_forecast, this, hints);
    progress_ =
        node_.subscribe("execution/progress", 1000, &SkillPlannerNode::on_progress, this, hints);
    // After subscribing: who sees this publisher may start, nothing will be missed.
    trajectory_ = node_.advertise<prf_msgs::SkillTrajectory>("skill/trajectory", 100);
    updater_.setHardwareID("none");
    updater_.add("planner", this, &SkillPlannerNode::diagnose);
  }

 private:
  void warn_of_lost_shape() const {
    const Demonstration& demonstration = skill_.session().demonstration();
    const double loss = shape_loss(demonstration.positions(), weights_);
    if (loss < kShapeLossWarning) return;
    ROS_WARN(
        "w_elastic %g pulls a plan of %zu nodes straight: %.0f %% of the demonstrated shape "
        "is lost without any editing (a disturbance decays over %.1f nodes)",
        weights_.elastic, demonstration.samples().size(), 100.0 * loss, weights_.decay_nodes());
  }

  bool in_planning_frame(const std_msgs::Header& header, const char* topic) {
    if (header.frame_id == frame_) return true;
    ++wrong_frame_;
    ROS_WARN_THROTTLE(5.0, "%s is in frame '%s', must be '%s': dropped", topic,
                      header.frame_id.c_str(), frame_.c_str());
    return false;
  }

  void on_forecast(const prf_msgs::TargetForecast& message) {
    if (!in_planning_frame(message.header, "target/forecast")) return;
    queue_.add(forecast_from(message));
    answer_decided_requests();
  }

  void on_progress(const prf_msgs::ExecutionProgress& message) {
    if (!in_planning_frame(message.header, "execution/progress")) return;
    queue_.add(progress_from(message));
    answer_decided_requests();
  }

  prf_msgs::SkillTrajectory answer(const JoinedRequest& request) {
    const Progress& progress = request.progress;
    const std::string before = skill_.demonstration();
    if (const auto reason = skill_.follow(progress.wanted)) {
      if (message_ != *reason) ROS_WARN("demonstration refused: %s", reason->c_str());
      status_ = AnswerStatus::kNoPlan;
      message_ = *reason;
      return refusal_from(progress, skill_, *reason);
    }
    if (skill_.demonstration() != before) {
      ROS_INFO("follows %s", skill_.demonstration().c_str());
      warn_of_lost_shape();
    }
    const auto start = std::chrono::steady_clock::now();
    const SkillAnswer answer =
        skill_.session().answer(progress, request.forecast ? &*request.forecast : nullptr);
    note_solve_time(std::chrono::steady_clock::now() - start);
    note_status(answer);
    return trajectory_from(progress, skill_, answer);
  }

  void note_status(const SkillAnswer& answer) {
    status_ = answer.status;
    message_ = answer.message;
    if (answer.status != AnswerStatus::kKept) return;
    ++kept_;
    ROS_WARN_THROTTLE(5.0, "last plan kept: %s", answer.message.c_str());
  }

  void answer_decided_requests() {
    while (const auto request = queue_.next()) {
      if (request->new_run) {
        ROS_INFO("stamps went back: new run");
        skill_.session().reset();
      }
      trajectory_.publish(answer(*request));
      ++answers_;
    }
    updater_.update();
  }

  // Says only that it was late: which plan goes out must not depend on the machine.
  void note_solve_time(std::chrono::duration<double> time) {
    solve_time_ = time;
    was_late_ = time.count() > late_after_;
    if (!was_late_) return;
    ++late_;
    ROS_WARN_THROTTLE(5.0, "solve took %.6f s, late_after is %.6f s", time.count(), late_after_);
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    const bool good = (status_ == AnswerStatus::kSolved && !was_late_) || answers_ == 0;
    status.summary(
        good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
        message_.empty() ? (was_late_ ? "solve was late" : "planning") : message_);
    status.add("answers", answers_);
    status.add("kept plans", kept_);
    status.add("late solves", late_);
    status.add("dropped, wrong frame", wrong_frame_);
    status.add("requests waiting for their forecast", queue_.waiting());
    status.add("last solve time, us", 1e6 * solve_time_.count());
  }

  std::string frame_;
  double late_after_;  // s
  ElteWeights weights_;
  FollowedSkill skill_;
  RequestQueue queue_;
  std::size_t answers_ = 0;
  std::size_t kept_ = 0;
  std::size_t late_ = 0;
  bool was_late_ = false;
  std::size_t wrong_frame_ = 0;
  AnswerStatus status_ = AnswerStatus::kNoPlan;
  std::string message_;
  std::chrono::duration<double> solve_time_{0.0};

  ros::NodeHandle node_;
  ros::Publisher trajectory_;
  ros::Subscriber forecast_;
  ros::Subscriber progress_;
  diagnostic_updater::Updater updater_;
};

}  // namespace
}  // namespace elte_planner

int main(int argc, char** argv) {
  ros::init(argc, argv, "skill_planner");
  return prf_ros::run([] {
    elte_planner::SkillPlannerNode node(elte_planner::load_node_params(ros::NodeHandle("~")));
    ros::spin();
  });
}
