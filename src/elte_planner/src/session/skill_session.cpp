// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/skill_session.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <prf_core/require.hpp>
#include <sstream>
#include <stdexcept>

#include "elte_planner/orientation_blend.hpp"

namespace elte_planner {
namespace {

using prf_core::pose_from;
using prf_core::TargetForecast;
using prf_core::TargetStatus;

// Growth of the goals' radius with the distance from the end, m/m, chosen by hand: 2 cm at 0.2 m.
constexpr double kNarrowing = 0.1;
constexpr double kShapeLossWarning = 0.5;  // share of the shape that may be lost
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Eigen::Quaterniond> orientations(const std::vector<TimedPose>& samples) {
  std::vector<Eigen::Quaterniond> result;
  result.reserve(samples.size());
  for (const TimedPose& sample : samples) result.push_back(sample.pose.orientation);
  return result;
}

// The last nodes that are within `length` of the end, at least the end itself.
std::vector<TimedPose> approach(const Demonstration& demonstration, double length) {
  const auto& nodes = demonstration.samples();
  const Eigen::Vector3d end = nodes.back().pose.position;
  auto first = nodes.end() - 1;
  while (first != nodes.begin() && ((first - 1)->pose.position - end).norm() <= length) --first;
  const Eigen::Isometry3d to_target = demonstration.target().isometry().inverse();
  std::vector<TimedPose> result(first, nodes.end());
  for (TimedPose& node : result) node.pose = pose_from(to_target * node.pose.isometry());
  return result;
}

}  // namespace

void SessionParams::validate() const {
  using prf_core::require_between;
  require_between("nodes", nodes, 3, 10000);
  weights.validate();
  // A step of a tenth of a millimetre is less than the hand can be measured.
  prf_core::require(max_step == 0.0 || (max_step >= 1e-4 && max_step <= 1.0), "max_step", max_step,
                    "0 or within [0.0001, 1] m");
  require_between("horizon_max", horizon_max, 0.0, 60.0, "s");
  require_between("confidence", confidence, 0.001, 0.999);
  require_between("radius_min", radius_min, 0.0, 1.0, "m");
  require_between("radius_max", radius_max, radius_min, 1.0, "m");
  require_between("approach_length", approach_length, 0.0, 10.0, "m");
  require_between("max_iterations", max_iterations, 1, 1000000);
  require_between("clearance", clearance, 0.001, 1.0, "m");
  prf_core::require(obstacles.empty() || planner != "elastic_map", "planner", planner,
                    "elte, lte or dmp, which keep clear of obstacles");
}

SkillSession::SkillSession(const SessionParams& params, const Demonstration& demonstration)
    : params_(params),
      demonstration_(demonstration.resampled_by_arc_length(
          static_cast<std::size_t>((params.validate(), params.nodes)))),
      confidence_radius_(3, params.confidence),
      goal_in_target_(demonstration_.goal_in_target()),
      approach_(approach(demonstration_, params.approach_length)),
      demonstrated_orientations_(orientations(demonstration_.samples())),
      planner_(make_skill_planner(
          params.planner, demonstration_.positions(), params.weights,
          {params.max_step > 0.0 ? params.max_step : kInfinity, params.max_iterations})) {
  const Eigen::Index begin = params.nodes - static_cast<Eigen::Index>(approach_.size());
  for (const PlacedVia& via : params_.via_points) {
    const Eigen::Index node = via.node(params.nodes);
    prf_core::require(node >= 2 && node < begin, "via_points: node of a share of the path", node,
                      "within [2, " + std::to_string(begin - 1) + "], before the approach");
  }
}

void Progress::validate(Eigen::Index nodes) const {
  using prf_core::require;
  using prf_core::require_between;
  using prf_core::to_seconds;
  require(frozen >= 0 && frozen <= nodes, "frozen", frozen,
          "within [0, " + std::to_string(nodes) + "]");
  require_between("time_to_go", to_seconds(time_to_go), 0.0, to_seconds(kMaxTimeToGo), "s");
  require(forecast_stamp <= stamp + kMaxForecastLead, "forecast_stamp minus stamp",
          to_seconds(forecast_stamp - stamp),
          "at most " + std::to_string(to_seconds(kMaxForecastLead)) + " s");
}

void SkillSession::reset() { plan_.reset(); }

std::string SkillSession::shape_warning() const {
  const double loss = shape_loss(demonstration_.positions(), params_.weights);
  if (loss < kShapeLossWarning) return {};
  std::ostringstream text;
  text << "w_elastic " << params_.weights.elastic << " pulls a plan of " << params_.nodes
       << " nodes straight: " << std::lround(100.0 * loss)
       << " % of the demonstrated shape is lost without any editing (a disturbance decays over "
       << std::setprecision(2) << params_.weights.decay_nodes() << " nodes)";
  return text.str();
}

SkillResult SkillSession::plan(const Progress& progress, const TargetForecast* forecast,
                               const std::vector<PlacedObstacle>& seen) {
  const Eigen::Index frozen =
      plan_ ? std::clamp<Eigen::Index>(progress.frozen, 2, static_cast<Eigen::Index>(params_.nodes))
            : 2;
  const bool once = params_.adaptation == Adaptation::kOnce;
  if (once && plan_) {
    SkillResult repeated = *plan_;
    repeated.frozen = frozen;
    return repeated;
  }
  if (forecast == nullptr) return keep("the forecast did not arrive", frozen);
  switch (forecast->status) {
    case TargetStatus::kNoTarget:
      return keep("there is no target yet", frozen);
    case TargetStatus::kLost:
      return keep("the target is lost", frozen);
    case TargetStatus::kCoasting:
      if (once) return keep("the target is not tracked yet", frozen);
      break;
    case TargetStatus::kTracking:
      break;
  }
  try {
    forecast->validate();
    const prf_core::Stamp end_stamp = progress.stamp + progress.time_to_go;
    return adapt(frozen, goals(*forecast, end_stamp, frozen),
                 surroundings(seen, frozen, *forecast, end_stamp));
  } catch (const std::invalid_argument& refused) {
    return keep(refused.what(), frozen);
  }
}

prf_core::TargetPrediction SkillSession::target_at(std::size_t node, const TargetForecast& forecast,
                                                   prf_core::Stamp end_stamp) const {
  using prf_core::Duration;
  const auto& nodes = demonstration_.samples();
  const Duration horizon_max =
      prf_core::from_seconds(params_.adaptation == Adaptation::kOnce ? 0.0 : params_.horizon_max);
  const Duration before_end = prf_core::from_seconds(nodes.back().time - nodes[node].time);
  const Duration horizon =
      std::clamp(end_stamp - before_end - forecast.stamp, Duration{0}, horizon_max);
  return prf_core::predicted_target(forecast, forecast.stamp + horizon);
}

std::vector<SkillSession::NodeGoal> SkillSession::goals(const TargetForecast& forecast,
                                                        prf_core::Stamp end_stamp,
                                                        Eigen::Index frozen) const {
  std::vector<NodeGoal> result;
  result.reserve(approach_.size());
  const TimedPose& end = approach_.back();
  // Nodes beyond either end of the forecast share one covariance.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double radius = params_.radius_min;
  for (std::size_t i = 0; i < approach_.size(); ++i) {
    const TimedPose& node = approach_[i];
    const auto target = target_at(static_cast<std::size_t>(params_.nodes) - approach_.size() + i,
                                  forecast, end_stamp);
    result.push_back({pose_from(target.target.pose.isometry() * node.pose.isometry()), 0.0});
    const std::size_t to_end = approach_.size() - 1 - i;
    if (to_end > 0 && params_.nodes - 1 - static_cast<Eigen::Index>(to_end) < frozen) continue;
    if (target.position_covariance() != covariance) {
      covariance = target.position_covariance();
      radius = std::clamp(confidence_radius_(covariance, params_.radius_max), params_.radius_min,
                          params_.radius_max);
    }
    const double distance = (node.pose.position - end.pose.position).norm();
    result.back().radius = radius + kNarrowing * distance;
  }
  return result;
}

SkillResult SkillSession::adapt(Eigen::Index frozen, const std::vector<NodeGoal>& goals,
                                PlanRequest request) {
  SkillResult result;
  result.poses = plan_ ? plan_->poses : demonstration_.samples();
  result.frozen = frozen;
  result.radius = goals.back().radius;

  request.previous.resize(params_.nodes, 3);
  for (Eigen::Index k = 0; k < params_.nodes; ++k) {
    request.previous.row(k) = result.poses[static_cast<std::size_t>(k)].pose.position.transpose();
  }
  request.frozen = frozen;
  request.goal = goals.back().pose.position;
  request.radius = result.radius;
  std::vector<Eigen::Quaterniond> orientation_goals;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const auto node = static_cast<Eigen::Index>(result.poses.size() - goals.size() + i);
    orientation_goals.push_back(goals[i].pose.orientation);
    if (node >= frozen && i + 1 < goals.size()) {
      request.approach.push_back({node, goals[i].pose.position, goals[i].radius});
    }
  }
  const PlanResult plan = planner_->plan(request);
  if (plan.status == PlanStatus::kFailed) return keep(plan.message, frozen);
  if (plan.status == PlanStatus::kNoWay) {
    SkillResult blocked = keep(plan.message, frozen);
    if (plan_) blocked.status = SkillStatus::kBlocked;
    return blocked;
  }

  const std::vector<Eigen::Quaterniond> blended = blend_orientations(
      demonstrated_orientations_, orientations(result.poses), frozen, orientation_goals);
  for (std::size_t k = 0; k < result.poses.size(); ++k) {
    result.poses[k].pose = {plan.positions.row(static_cast<Eigen::Index>(k)).transpose(),
                            blended[k]};
  }
  result.status = plan.status == PlanStatus::kSolved ? SkillStatus::kSolved : SkillStatus::kRelaxed;
  result.message = plan.message;
  result.kkt_residual = plan.kkt_residual;
  result.slack = plan.slack;
  plan_ = result;
  return result;
}

PlanRequest SkillSession::surroundings(const std::vector<PlacedObstacle>& seen, Eigen::Index frozen,
                                       const TargetForecast& forecast,
                                       prf_core::Stamp end_stamp) const {
  PlanRequest result;
  result.clearance = params_.clearance;
  const auto target_of = [&](std::size_t node) {
    return target_at(node, forecast, end_stamp).target.pose;
  };
  for (const auto* obstacles : {&params_.obstacles, &seen}) {
    for (const PlacedObstacle& obstacle : *obstacles) {
      if (!obstacle.on_target) {
        result.obstacles.push_back(obstacle.shape);
        continue;
      }
      MovingObstacle& places = result.moving.emplace_back();
      for (std::size_t k = 0; k < demonstration_.samples().size(); ++k) {
        places.push_back(obstacle.in_planning_frame(target_of(k)));
      }
    }
  }
  for (const PlacedVia& via : params_.via_points) {
    const Eigen::Index node = via.node(params_.nodes);
    if (node < frozen) continue;
    result.approach.push_back(
        {node, via.in_planning_frame(target_of(static_cast<std::size_t>(node))), via.radius});
  }
  return result;
}

SkillResult SkillSession::keep(const std::string& reason, Eigen::Index frozen) const {
  SkillResult kept = plan_.value_or(SkillResult{});
  kept.status = plan_ ? SkillStatus::kKept : SkillStatus::kNoPlan;
  kept.message = reason;
  kept.frozen = plan_ ? frozen : 0;
  return kept;
}

}  // namespace elte_planner
