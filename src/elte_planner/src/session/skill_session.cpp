// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/skill_session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/require.hpp>
#include <stdexcept>

#include "elte_planner/confidence_radius.hpp"
#include "elte_planner/orientation_blend.hpp"

namespace elte_planner {
namespace {

using prf_core::pose_from;

constexpr double kNanosecond = 1e-9;
// Growth of the goals' radius with the distance from the end, m/m, chosen by hand: 2 cm at 0.2 m.
constexpr double kNarrowing = 0.1;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_usable(const TargetPrediction& prediction) {
  return std::isfinite(prediction.horizon) && prediction.target.is_finite() &&
         prediction.covariance.allFinite() && prediction.velocity.allFinite() &&
         std::abs(prediction.target.orientation.norm() - 1.0) <=
             prf_core::kUnitQuaternionTolerance;
}

// Position at the fraction s of the time between two predictions, as the cubic of both velocities.
Eigen::Vector3d hermite(const TargetPrediction& a, const TargetPrediction& b, double s) {
  const double span = b.horizon - a.horizon;
  const Eigen::Vector3d gap = b.target.position - a.target.position;
  const Eigen::Vector3d start = span * a.velocity;
  const Eigen::Vector3d end = span * b.velocity;
  return a.target.position +
         s * (start + s * (3.0 * gap - 2.0 * start - end + s * (start + end - 2.0 * gap)));
}

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
  require_between("max_step", max_step, 0.0, 1.0, "m");
  require_between("horizon_max", horizon_max, 0.0, 60.0, "s");
  prf_core::require(confidence > 0.0 && confidence < 1.0, "confidence", confidence,
                    "within (0, 1)");
  require_between("radius_min", radius_min, 0.0, 1.0, "m");
  require_between("radius_max", radius_max, radius_min, 1.0, "m");
  require_between("approach_length", approach_length, 0.0, 10.0, "m");
}

std::optional<TargetPrediction> predicted_target(const Forecast& forecast, double horizon) {
  const auto& predictions = forecast.predictions;
  const auto not_rising = [](const auto& a, const auto& b) { return !(a.horizon < b.horizon); };
  if (predictions.empty() || !std::all_of(predictions.begin(), predictions.end(), is_usable) ||
      std::adjacent_find(predictions.begin(), predictions.end(), not_rising) != predictions.end()) {
    return std::nullopt;
  }
  const auto after = std::find_if(predictions.begin(), predictions.end(),
                                  [&](const auto& p) { return p.horizon >= horizon; });
  if (after == predictions.begin()) return predictions.front();
  if (after == predictions.end()) return predictions.back();
  const TargetPrediction& a = *(after - 1);
  const TargetPrediction& b = *after;
  const double s = (horizon - a.horizon) / (b.horizon - a.horizon);
  return TargetPrediction{horizon,
                          {hermite(a, b, s), a.target.orientation.slerp(s, b.target.orientation)},
                          (1.0 - s) * a.covariance + s * b.covariance,
                          (1.0 - s) * a.velocity + s * b.velocity};
}

SkillSession::SkillSession(const SessionParams& params, const Demonstration& demonstration)
    : params_(params),
      demonstration_(demonstration.resampled_by_arc_length(
          static_cast<std::size_t>((params.validate(), params.nodes)))),
      goal_in_target_(demonstration_.goal_in_target()),
      approach_(approach(demonstration_, params.approach_length)),
      demonstrated_orientations_(orientations(demonstration_.samples())),
      planner_(make_skill_planner(params.planner, demonstration_.positions(), params.weights,
                                  params.max_step > 0.0 ? params.max_step : kInfinity)) {}

void SkillSession::reset() { plan_.reset(); }

SkillResult SkillSession::plan(const Progress& progress, const Forecast* forecast) {
  const Eigen::Index frozen =
      std::clamp<Eigen::Index>(progress.frozen, 2, static_cast<Eigen::Index>(params_.nodes));
  const bool once = params_.adaptation == Adaptation::kOnce;
  if (once && plan_) {
    SkillResult repeated = *plan_;
    repeated.frozen = frozen;
    return repeated;
  }
  if (forecast == nullptr) return keep("the forecast never came", frozen);
  switch (forecast->status) {
    case TargetStatus::kNoTarget:
      return keep("no target was seen yet", frozen);
    case TargetStatus::kLost:
      return keep("the target is lost", frozen);
    case TargetStatus::kCoasting:
      if (once) return keep("the target is not tracked yet", frozen);
      break;
    case TargetStatus::kTracking:
      break;
  }
  const double age = kNanosecond * static_cast<double>(progress.stamp - forecast->stamp);
  const double ahead = once ? 0.0 : progress.time_to_go + age;
  if (!std::isfinite(ahead)) return keep("time_to_go is not finite", frozen);
  try {
    const auto goals = this->goals(*forecast, ahead);
    if (!goals) return keep("the forecast has no usable prediction", frozen);
    return adapt(frozen, *goals);
  } catch (const std::invalid_argument& refused) {
    return keep(refused.what(), frozen);
  }
}

// ahead: time of the last node after the forecast's stamp, s.
std::optional<std::vector<SkillSession::NodeGoal>> SkillSession::goals(const Forecast& forecast,
                                                                       double ahead) const {
  std::vector<NodeGoal> result;
  const TimedPose& end = approach_.back();
  const bool once = params_.adaptation == Adaptation::kOnce;
  for (const TimedPose& node : approach_) {
    const double horizon = once ? 0.0 : ahead - (end.time - node.time);
    const auto target = predicted_target(forecast, std::clamp(horizon, 0.0, params_.horizon_max));
    if (!target) return std::nullopt;
    const double radius = std::clamp(confidence_radius(target->covariance, params_.confidence),
                                     params_.radius_min, params_.radius_max);
    const double distance = (node.pose.position - end.pose.position).norm();
    result.push_back({pose_from(target->target.isometry() * node.pose.isometry()),
                      radius + kNarrowing * distance});
  }
  return result;
}

SkillResult SkillSession::adapt(Eigen::Index frozen, const std::vector<NodeGoal>& goals) {
  SkillResult result;
  result.poses = plan_ ? plan_->poses : demonstration_.samples();
  result.frozen = frozen;
  result.radius = goals.back().radius;

  PlanRequest request;
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

  const std::vector<Eigen::Quaterniond> blended = blend_orientations(
      demonstrated_orientations_, orientations(result.poses), frozen, orientation_goals);
  for (std::size_t k = 0; k < result.poses.size(); ++k) {
    result.poses[k].pose = {plan.positions.row(static_cast<Eigen::Index>(k)).transpose(),
                            blended[k]};
  }
  result.status =
      plan.status == PlanStatus::kSolved ? SkillStatus::kSolved : SkillStatus::kRelaxed;
  result.message = plan.message;
  result.kkt_residual = plan.kkt_residual;
  result.slack = plan.slack;
  plan_ = result;
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
