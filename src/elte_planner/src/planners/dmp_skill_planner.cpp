// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/dmp_skill_planner.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>

#include "frame_displacement.hpp"

namespace elte_planner {

void DmpParams::validate() const {
  using prf_core::require_between;
  require_between("basis_functions", basis_functions, 2, 1000);
  require_between("stiffness", stiffness, 1e-3, 1e5);
  require_between("damping", damping, 1e-3, 1e4);
  require_between("phase_decay", phase_decay, 0.1, 20.0);
  require_between("activation", activation, 1e-6, 0.99);
  require_between("repulsion", repulsion, 0.0, 1e3);
}

DmpSkillPlanner::DmpSkillPlanner(const Eigen::MatrixXd& demonstration, const DmpParams& params)
    : demonstration_(demonstration), params_(params) {
  validate_demonstration_nodes(demonstration);
  params.validate();
  fit();
}

Eigen::VectorXd DmpSkillPlanner::activations(double phase) const {
  return (-widths_.array() * (phase - centres_.array()).square()).exp();
}

void DmpSkillPlanner::fit() {
  const Eigen::Index count = params_.basis_functions;
  centres_.resize(count);
  widths_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double time = static_cast<double>(i) / static_cast<double>(count - 1);
    centres_[i] = std::exp(-params_.phase_decay * time);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index a = std::min(i, count - 2);
    const double spacing = centres_[a + 1] - centres_[a];
    widths_[i] = -std::log(params_.activation) / (spacing * spacing);
  }

  const Eigen::Index n = demonstration_.rows();
  const double dt = 1.0 / static_cast<double>(n - 1);
  const Eigen::RowVectorXd start = demonstration_.row(0);
  const Eigen::RowVectorXd goal = demonstration_.row(n - 1);
  Eigen::MatrixXd numerator = Eigen::MatrixXd::Zero(count, demonstration_.cols());
  Eigen::VectorXd denominator = Eigen::VectorXd::Constant(count, 1e-12);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index inner = std::clamp<Eigen::Index>(k, 1, n - 2);
    const Eigen::RowVectorXd before = demonstration_.row(inner - 1);
    const Eigen::RowVectorXd after = demonstration_.row(inner + 1);
    const Eigen::RowVectorXd velocity = (after - before) / (2.0 * dt);
    const Eigen::RowVectorXd acceleration =
        (after - 2.0 * demonstration_.row(inner) + before) / (dt * dt);
    const double s = std::exp(-params_.phase_decay * dt * static_cast<double>(k));
    const Eigen::RowVectorXd force =
        (acceleration + params_.damping * velocity) / params_.stiffness -
        (goal - demonstration_.row(k)) + (goal - start) * s;
    const Eigen::VectorXd psi = activations(s);
    numerator += s * psi * force;
    denominator += s * s * psi;
  }
  weights_ = denominator.cwiseInverse().asDiagonal() * numerator;
}

Eigen::RowVectorXd DmpSkillPlanner::push(const PlanRequest& request, Eigen::Index k,
                                         const Eigen::RowVectorXd& x,
                                         const Eigen::RowVectorXd& v) const {
  constexpr double kLeast = 0.005;  // m, where the potential stops growing
  Eigen::RowVectorXd result = Eigen::RowVectorXd::Zero(x.size());
  const double speed = v.norm();
  if (!(speed > 0.0)) return result;
  const auto add = [&](const Obstacle& obstacle) {
    const Separation gap = separation(obstacle, x.transpose(), x.transpose());
    if (!(gap.distance > 0.0)) return;
    const Eigen::RowVectorXd normal = gap.normal.transpose();
    const double cosine = v.dot(normal) / speed;
    if (cosine >= 0.0) return;
    const double p = std::max(gap.distance - request.clearance, kLeast);
    const Eigen::RowVectorXd turn =  // gradient of cos theta
        (v / speed - cosine * normal) / std::max(gap.distance, kLeast);
    result += params_.repulsion * -cosine * speed / p * (2.0 * turn - cosine / p * normal);
  };
  for (const Obstacle& obstacle : request.obstacles) add(obstacle);
  for (const MovingObstacle& places : request.moving) add(places[static_cast<std::size_t>(k)]);
  return result;
}

PlanResult DmpSkillPlanner::plan(const PlanRequest& request) {
  validate_request(request, demonstration_);
  const Eigen::Index n = demonstration_.rows();
  if (request.frozen == n) return all_frozen(request);
  constexpr int kSubsteps = 20;
  const double node_time = 1.0 / static_cast<double>(n - 1);
  const double dt = node_time / kSubsteps;
  const Eigen::MatrixXd frame = frame_displacement(request, demonstration_);
  const Eigen::RowVectorXd goal = request.goal.transpose() - frame.row(n - 1);
  const Eigen::RowVectorXd start = request.previous.row(0);
  const bool free_space = request.obstacles.empty() && request.moving.empty();

  PlanResult result;
  result.positions = request.previous;
  const auto in_frame = [&](Eigen::Index k) -> Eigen::RowVectorXd {
    return request.previous.row(k) - frame.row(k);
  };
  Eigen::RowVectorXd x = in_frame(request.frozen - 1);
  Eigen::RowVectorXd v = (x - in_frame(request.frozen - 2)) / node_time;
  double time = node_time * static_cast<double>(request.frozen - 1);
  for (Eigen::Index k = request.frozen; k < n; ++k) {
    for (int i = 0; i < kSubsteps; ++i) {
      const double s = std::exp(-params_.phase_decay * time);
      const Eigen::VectorXd psi = activations(s);
      const Eigen::RowVectorXd forcing =
          (s / std::max(psi.sum(), 1e-300)) * psi.transpose() * weights_;
      v += dt *
           (params_.stiffness * (goal - x - (goal - start) * s + forcing) - params_.damping * v);
      if (!free_space) v += dt * push(request, k, x + frame.row(k), v);
      x += dt * v;
      time += dt;
    }
    result.positions.row(k) = x + frame.row(k);
  }
  if (!keeps_clear(result.positions, request)) {
    result.status = PlanStatus::kNoWay;
    result.message = "the obstacles do not push the primitive far enough off";
    return result;
  }
  const double miss = (goal - x).lpNorm<1>();
  result.slack = std::max(miss - request.radius, 0.0);
  result.status = result.slack > 0.0 ? PlanStatus::kRelaxed : PlanStatus::kSolved;
  if (result.slack > 0.0) result.message = "the primitive has not reached the goal at its end";
  return result;
}

}  // namespace elte_planner
