// SPDX-License-Identifier: BSD-3-Clause
//
// Dynamic movement primitive, to compare ELTE with (Pastor, Hoffmann, Asfour, Schaal 2009), per
// dimension:
//
//   v' = K (g - x) - D v - K (g - x0) s + K f(s),   x' = v,   s' = -alpha s
//   f(s) = s sum_i psi_i(s) w_i / sum_i psi_i(s),   psi_i(s) = exp(-h_i (s - c_i)^2)
//
// over the unit interval. The demonstration's nodes count as equally spaced in it; their times are
// not used. The weights are fitted to the demonstration by locally weighted regression. A plan goes
// on from the last frozen node with its velocity and the changed goal; the goal is approached, not
// met. x is the position in a frame that moves with the centres of the approach's balls; without an
// approach it rests.
//
// Obstacles push the hand off by the gradient of a dynamic potential (Park, Hoffmann, Pastor,
// Schaal 2008), which is added to v':
//
//   U = lambda (-cos theta)^2 |v| / p(x) where the hand comes nearer (cos theta < 0), else 0,
//
// p the distance from the obstacle beyond the clearance, theta the angle from the normal on it to
// the velocity. A hand that comes straight at an obstacle stops before it. A plan that ends nearer
// than the clearance all the same is kNoWay.
#pragma once

#include <Eigen/Core>
#include <string>

#include "elte_planner/skill_planner.hpp"

namespace elte_planner {

struct DmpParams {
  int basis_functions = 20;
  double stiffness = 120.0;        // K
  double damping = 40.0;           // D
  double phase_decay = 4.6051702;  // alpha: the phase ends at 0.01
  double activation = 0.1;         // of a basis function at its neighbour's centre
  double repulsion = 0.1;          // lambda, m^2 per unit of time

  void validate() const;  // throws std::invalid_argument
};

class DmpSkillPlanner : public SkillPlanner {
 public:
  explicit DmpSkillPlanner(const Eigen::MatrixXd& demonstration, const DmpParams& params = {});

  std::string name() const override { return "dmp"; }

  // Relaxed, with the slack, when the end stays outside the ball.
  [[nodiscard]] PlanResult plan(const PlanRequest& request) override;

 private:
  void fit();
  Eigen::VectorXd activations(double phase) const;
  // Acceleration off the obstacles at x with velocity v on the way to node k.
  Eigen::RowVectorXd push(const PlanRequest& request, Eigen::Index k, const Eigen::RowVectorXd& x,
                          const Eigen::RowVectorXd& v) const;

  Eigen::MatrixXd demonstration_;
  DmpParams params_;
  Eigen::VectorXd centres_;
  Eigen::VectorXd widths_;
  Eigen::MatrixXd weights_;  // basis functions x dimensions
};

}  // namespace elte_planner
