// SPDX-License-Identifier: BSD-3-Clause
//
// Elastic Laplacian trajectory editing with any number of constraints on nodes and steps:
//
//   minimise J(y) of elte_energy.hpp over the rows of y after the fixed ones, subject to
//     |y_j - p|_1 <= r         ball (r = 0: equality)
//     |y_j - p| <= h           box, per dimension (h = 0: equality, infinity: free)
//     n . (y_j - p) <= 0       half-space
//     |y_k - y_{k-1}|_1 <= s   step bound, optional, for every step that is not fixed
//
// Nodes count from 0; all lengths in the unit of the demonstration.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "elte_planner/elte_energy.hpp"

namespace elte_planner {

struct PointConstraint {
  enum class Shape { kBall, kBox, kHalfSpace };

  static PointConstraint ball(Eigen::Index node, Eigen::VectorXd centre, double radius);
  static PointConstraint box(Eigen::Index node, Eigen::VectorXd centre,
                             Eigen::VectorXd half_widths);
  static PointConstraint half_space(Eigen::Index node, Eigen::VectorXd boundary_point,
                                    Eigen::VectorXd outward_normal);
  static PointConstraint equality(Eigen::Index node, Eigen::VectorXd point);

  Shape shape = Shape::kBall;
  Eigen::Index node = 0;
  Eigen::VectorXd centre;       // of a half-space: a point of its boundary
  double radius = 0.0;          // of a ball
  Eigen::VectorXd half_widths;  // of a box
  Eigen::VectorXd normal;       // of a half-space, of any length but 0
};

struct EditProblem {
  Eigen::MatrixXd zeta;  // demonstration, nodes x dimensions
  ElteWeights weights;
  Eigen::MatrixXd fixed;  // values of the first rows of y, possibly none
  std::vector<PointConstraint> constraints;
  double max_step = std::numeric_limits<double>::infinity();
  double max_first_step = std::numeric_limits<double>::infinity();  // of the first free step

  void validate() const;  // throws std::invalid_argument
};

struct EditParams {
  double tolerance = 1e-13;    // of feasibility, relative to the largest coordinate of the
                               // demonstration and the constraints, from the first node
  int max_iterations = 20000;  // changes of the active set
};

enum class EditStatus {
  kSolved,
  kInfeasible,      // the message names the constraints that contradict each other
  kIllPosed,        // too little is given to determine the plan, the message says what
  kIterationLimit,  // numerical failure
};

struct EditSolution {
  EditStatus status = EditStatus::kIllPosed;
  std::string message;  // one line when not solved
  Eigen::MatrixXd y;    // nodes x dimensions; empty unless solved
  double energy = 0.0;  // J(y)
  double kkt_residual =
      0.0;  // largest violation of stationarity, of feasibility, or of a multiplier's sign

  // Force of each constraint on its node, constraints x dimensions. At a node the gradient of J is
  // minus the sum of its constraints' forces. The largest entry of a ball's force is -dJ/dr. The
  // force of an equality is -dJ/dp. The force of a half-space is along its normal. Row i is zero
  // when constraint i is not active.
  Eigen::MatrixXd forces;
  std::vector<int> active;  // constraints with a facet (one linear inequality) in the active set
  int active_facets = 0;    // of constraints and step bounds
  int iterations = 0;
};

// Dual active-set method (Goldfarb and Idnani 1983). Written in the steps between nodes, the
// Hessian is a tridiagonal M-matrix whose factor is computed without subtractions; of the 2^d
// facets of a ball only the violated one, sign(y_j - p), is ever formed. Keeps its memory: solving
// again with the same sizes, at least two fixed rows and no more active facets than before does not
// allocate.
class EditSolver {
 public:
  EditSolver();
  ~EditSolver();
  EditSolver(EditSolver&&) noexcept;
  EditSolver& operator=(EditSolver&&) noexcept;

  // Throws std::invalid_argument for an invalid problem.
  void solve(const EditProblem& problem, const EditParams& params, EditSolution& solution);

 private:
  class Workspace;
  std::unique_ptr<Workspace> workspace_;
};

[[nodiscard]] EditSolution solve(const EditProblem& problem, const EditParams& params = {});

}  // namespace elte_planner
