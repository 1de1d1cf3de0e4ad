// SPDX-License-Identifier: BSD-3-Clause
//
// The plan of one skill during one execution. plan() takes the forecast of the target and the
// progress of the execution, and bends the part of the skill that is not executed yet so that the
// hand reaches its demonstrated pose relative to the target.
//
// Node k of the plan is reached at t_k. Each of the last nodes (those within approach_length of the
// end) has a goal: its demonstrated pose in the target's frame, placed on the target as predicted
// for t_k. Its position may differ from the goal by an l1 ball of radius
//   r_k = clamp(r(P), radius_min, radius_max) + 0.1 |straight distance to the end|,
// 0.1 chosen by hand, where r(P) holds the probability `confidence` of the predicted position
// (confidence_radius.hpp). All poses are in the planning frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <prf_core/forecast.hpp>
#include <prf_core/time.hpp>
#include <string>
#include <vector>

#include "elte_planner/confidence_radius.hpp"
#include "elte_planner/demonstration.hpp"
#include "elte_planner/elte_energy.hpp"
#include "elte_planner/placed_obstacle.hpp"
#include "elte_planner/skill_planner.hpp"

namespace elte_planner {

// The demonstration that an execution asks for, see CurrentSkill.
struct DemonstrationRequest {
  std::string file;                        // absolute or beside the first one; empty: the first one
  std::uint32_t demonstration_switch = 0;  // counts the requests; a new number reads the file anew

  bool operator==(const DemonstrationRequest& other) const {
    return file == other.file && demonstration_switch == other.demonstration_switch;
  }
};

struct Progress {
  prf_core::Stamp stamp{0};
  prf_core::Stamp forecast_stamp{0};  // of the forecast in force; 0 for none
  Eigen::Index frozen = 0;            // leading nodes that must not move
  prf_core::Duration time_to_go{0};   // from the cursor to the last node
  DemonstrationRequest demonstration = {};

  static constexpr prf_core::Duration kMaxTimeToGo = std::chrono::hours(1);
  // How far the clock of the camera may be ahead of that of the arm.
  static constexpr prf_core::Duration kMaxForecastLead = std::chrono::milliseconds(100);

  // Throws std::invalid_argument with name, value and bound for what no execution of a plan with
  // this number of nodes can ask. Stamps lie within the bounds of ROS time.
  void validate(Eigen::Index nodes) const;
};

enum class Adaptation {
  kContinuous,  // to every forecast
  kOnce,        // to the first forecast of a tracked target; later calls repeat that plan
};

struct SessionParams {
  std::string planner;  // one of planner_names()
  Adaptation adaptation = Adaptation::kContinuous;
  int nodes = 0;  // of the plan, 3 .. 10000
  ElteWeights weights;
  double max_step = 0.0;         // m, greatest l1 distance of consecutive nodes; 0: no bound
                                 // else within [0.0001, 1]
  double horizon_max = 0.0;      // s, farthest look ahead, within [0, 60]
  double confidence = 0.0;       // probability of the end point's l1 ball, within [0.001, 0.999]
  double radius_min = 0.0;       // m, within [0, 1]
  double radius_max = 0.0;       // m, within [radius_min, 1]
  double approach_length = 0.0;  // m, of the skill's end where every node has a goal; 0: the last
  // Every segment not executed keeps `clearance` from them, with the target as predicted for the
  // time of its end. When no way is found, the plan is kBlocked.
  std::vector<PlacedObstacle> obstacles = {};
  double clearance = 0.03;                 // m, within [0.001, 1]
  std::vector<PlacedVia> via_points = {};  // before the approach
  // Deadline of a solve, the same on every machine; then the last plan is kept.
  int max_iterations = SolveLimits{}.max_iterations;

  void validate() const;  // throws std::invalid_argument with name, value and bound
};

// kKept: the last plan, still to be followed. kBlocked: the last plan, which no way that keeps
// clear of the obstacles could replace; not to be followed further.
enum class SkillStatus { kNoPlan, kSolved, kRelaxed, kKept, kBlocked };

struct SkillResult {
  SkillStatus status = SkillStatus::kNoPlan;
  std::string message;  // one line when not solved
  Eigen::Index frozen = 0;
  double kkt_residual = 0.0;  // m
  double radius = 0.0;        // m, of the end point's ball
  double slack = 0.0;         // m, added to it when relaxed
  std::vector<TimedPose> poses;
};

class SkillSession {
 public:
  // Throws std::invalid_argument for parameters that validate() or make_skill_planner() refuses.
  SkillSession(const SessionParams& params, const Demonstration& demonstration);

  // Without a plan of its own (a node that was started anew) it cannot keep the frozen nodes and
  // adapts them all, which is nearest to what was executed.
  // forecast: the one that the progress names; null when it was lost on its way. When it is null
  // or invalid, has no target or a lost one, or the planner fails, the result is the last plan as
  // kKept, or no poses as kNoPlan before the first plan. A coasting target is used, but not for
  // kOnce. Does not throw for a bad forecast. `seen`: obstacles beside those of the parameters.
  [[nodiscard]] SkillResult plan(const Progress& progress, const prf_core::TargetForecast* forecast,
                                 const std::vector<PlacedObstacle>& seen = {});

  void reset();  // a new run: forgets the plan

  // A warning in one line when the weights alone remove at least half of the demonstrated shape
  // (shape_loss() in elte_energy.hpp); else empty.
  [[nodiscard]] std::string shape_warning() const;

  const Pose& goal_in_target() const { return goal_in_target_; }
  const Demonstration& demonstration() const { return demonstration_; }  // the plan's nodes
  std::string planner_name() const { return planner_->name(); }

 private:
  struct NodeGoal {
    Pose pose;
    double radius;  // of the l1 ball, m; 0 at a frozen node but the last
  };

  // The target as predicted for the time of a node; the end is reached at end_stamp.
  prf_core::TargetPrediction target_at(std::size_t node, const prf_core::TargetForecast& forecast,
                                       prf_core::Stamp end_stamp) const;
  std::vector<NodeGoal> goals(const prf_core::TargetForecast& forecast, prf_core::Stamp end_stamp,
                              Eigen::Index frozen) const;
  SkillResult adapt(Eigen::Index frozen, const std::vector<NodeGoal>& goals, PlanRequest request);
  // Obstacles and via-points of a request.
  PlanRequest surroundings(const std::vector<PlacedObstacle>& seen, Eigen::Index frozen,
                           const prf_core::TargetForecast& forecast,
                           prf_core::Stamp end_stamp) const;
  SkillResult keep(const std::string& reason, Eigen::Index frozen) const;

  SessionParams params_;
  Demonstration demonstration_;  // resampled to the plan's nodes
  ConfidenceRadius confidence_radius_;
  Pose goal_in_target_;
  std::vector<TimedPose> approach_;  // the last nodes, in the target's frame
  std::vector<Eigen::Quaterniond> demonstrated_orientations_;
  std::unique_ptr<SkillPlanner> planner_;
  std::optional<SkillResult> plan_;  // the last feasible one
};

}  // namespace elte_planner
