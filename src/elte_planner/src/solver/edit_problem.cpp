// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/edit_problem.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace elte_planner {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

// Builds its text only to refuse: checking does not allocate.
template <typename Name>
void check_bound(Name&& name, double value) {
  if (!(value >= 0.0)) {
    refuse(name() + " is " + std::to_string(value) + ", must be at least 0");
  }
}

void check_constraint(const PointConstraint& constraint, std::size_t index, Eigen::Index nodes,
                      Eigen::Index dimensions) {
  const auto name = [index] { return "constraint " + std::to_string(index); };
  if (constraint.node < 0 || constraint.node >= nodes) {
    refuse(name() + " is on node " + std::to_string(constraint.node) + ", must be within [0, " +
           std::to_string(nodes - 1) + "]");
  }
  const bool box = constraint.shape == PointConstraint::Shape::kBox;
  const bool half_space = constraint.shape == PointConstraint::Shape::kHalfSpace;
  if (constraint.centre.size() != dimensions ||
      (box && constraint.half_widths.size() != dimensions) ||
      (half_space && constraint.normal.size() != dimensions)) {
    refuse(name() + " has " + std::to_string(constraint.centre.size()) +
           " coordinates, must have " + std::to_string(dimensions));
  }
  if (!is_within_magnitude(constraint.centre)) {
    refuse(name() + " has a coordinate that is not finite or above 1e100");
  }
  if (half_space) {
    if (!is_within_magnitude(constraint.normal) || !(constraint.normal.norm() > 1e-100)) {
      refuse(name() + " has a normal that is zero, not finite or above 1e100");
    }
    return;
  }
  if (!box) {
    check_bound([&] { return name() + " radius"; }, constraint.radius);
    return;
  }
  for (const double half_width : constraint.half_widths) {
    check_bound([&] { return name() + " half width"; }, half_width);
  }
}

}  // namespace

PointConstraint PointConstraint::ball(Eigen::Index node, Eigen::VectorXd centre, double radius) {
  return {Shape::kBall, node, std::move(centre), radius, {}, {}};
}

PointConstraint PointConstraint::box(Eigen::Index node, Eigen::VectorXd centre,
                                     Eigen::VectorXd half_widths) {
  return {Shape::kBox, node, std::move(centre), 0.0, std::move(half_widths), {}};
}

PointConstraint PointConstraint::half_space(Eigen::Index node, Eigen::VectorXd boundary_point,
                                            Eigen::VectorXd outward_normal) {
  return {Shape::kHalfSpace, node, std::move(boundary_point), 0.0, {}, std::move(outward_normal)};
}

PointConstraint PointConstraint::equality(Eigen::Index node, Eigen::VectorXd point) {
  return ball(node, std::move(point), 0.0);
}

void EditProblem::validate() const {
  validate_demonstration_nodes(zeta);
  weights.validate();
  if (fixed.rows() > zeta.rows() || (fixed.rows() > 0 && fixed.cols() != zeta.cols())) {
    refuse("fixed rows are " + std::to_string(fixed.rows()) + " x " + std::to_string(fixed.cols()) +
           ", must be at most " + std::to_string(zeta.rows()) + " x " +
           std::to_string(zeta.cols()));
  }
  if (!is_within_magnitude(fixed)) {
    refuse("fixed rows have a coordinate that is not finite or above 1e100");
  }
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    check_constraint(constraints[i], i, zeta.rows(), zeta.cols());
  }
  check_bound([] { return std::string("max_step"); }, max_step);
  check_bound([] { return std::string("max_first_step"); }, max_first_step);
}

}  // namespace elte_planner
