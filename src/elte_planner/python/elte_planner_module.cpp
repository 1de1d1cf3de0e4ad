// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "elte_planner/confidence_radius.hpp"
#include "elte_planner/edit_problem.hpp"
#include "elte_planner/elte_energy.hpp"
#include "elte_planner/endpoint_solver.hpp"
#include "elte_planner/obstacle_avoidance.hpp"

namespace py = pybind11;

namespace elte_planner {

ElteWeights weights_from(double elastic, double bending, const std::string& laplacian) {
  ElteWeights weights{elastic, bending, Laplacian::kFreeEnds};
  if (laplacian == "row_normalised") {
    weights.laplacian = Laplacian::kRowNormalised;
  } else if (laplacian != "free_ends") {
    throw std::invalid_argument("laplacian is '" + laplacian +
                                "', must be 'free_ends' or 'row_normalised'");
  }
  weights.validate();
  return weights;
}

namespace {

const char* name_of(EditStatus status) {
  switch (status) {
    case EditStatus::kSolved:
      return "solved";
    case EditStatus::kInfeasible:
      return "infeasible";
    case EditStatus::kIllPosed:
      return "ill_posed";
    case EditStatus::kIterationLimit:
      break;
  }
  return "iteration_limit";
}

const char* name_of(AvoidanceStatus status) {
  switch (status) {
    case AvoidanceStatus::kSolved:
      return "solved";
    case AvoidanceStatus::kNotFound:
      return "not_found";
    case AvoidanceStatus::kInfeasible:
      return "infeasible";
    case AvoidanceStatus::kIllPosed:
      return "ill_posed";
    case AvoidanceStatus::kIterationLimit:
      break;
  }
  return "iteration_limit";
}

EditProblem problem_from(const Eigen::MatrixXd& zeta,
                         const std::vector<PointConstraint>& constraints,
                         const std::optional<Eigen::MatrixXd>& fixed, double w_elastic,
                         double w_bending, const std::string& laplacian, double max_step,
                         double max_first_step) {
  EditProblem problem;
  problem.zeta = zeta;
  problem.weights = weights_from(w_elastic, w_bending, laplacian);
  problem.fixed = fixed.value_or(Eigen::MatrixXd(0, zeta.cols()));
  problem.constraints = constraints;
  problem.max_step = max_step;
  problem.max_first_step = max_first_step;
  return problem;
}

void bind_solver(py::module_& m) {
  py::class_<PointConstraint>(m, "PointConstraint",
                              "A constraint on one node; see ball, box, equality.")
      .def_readonly("node", &PointConstraint::node)
      .def_readonly("centre", &PointConstraint::centre);
  m.def("ball", &PointConstraint::ball, py::arg("node"), py::arg("centre"), py::arg("radius"),
        "|y[node] - centre|_1 <= radius. centre: (d,). radius 0 is an equality.");
  m.def(
      "box", &PointConstraint::box, py::arg("node"), py::arg("centre"), py::arg("half_widths"),
      "|y[node] - centre| <= half_widths, per dimension. centre, half_widths: (d,), inf is free.");
  m.def("half_space", &PointConstraint::half_space, py::arg("node"), py::arg("boundary_point"),
        py::arg("outward_normal"), "outward_normal . (y[node] - boundary_point) <= 0. Both: (d,).");
  m.def("equality", &PointConstraint::equality, py::arg("node"), py::arg("point"),
        "y[node] = point. point: (d,).");

  py::class_<EditSolution>(m, "Solution", "What solve() found.")
      .def_property_readonly(
          "status", [](const EditSolution& s) { return name_of(s.status); },
          "'solved', 'infeasible', 'ill_posed' or 'iteration_limit'.")
      .def_readonly("message", &EditSolution::message, "Why it is not solved, one line.")
      .def_readonly("y", &EditSolution::y, "Edited trajectory, (T, d); empty unless solved.")
      .def_readonly("energy", &EditSolution::energy, "J(y).")
      .def_readonly("kkt_residual", &EditSolution::kkt_residual,
                    "Largest violation of the optimality conditions.")
      .def_readonly("forces", &EditSolution::forces,
                    "(constraints, d); the gradient of J is minus their sum per node.")
      .def_readonly("active", &EditSolution::active, "Indices of the active constraints.")
      .def_readonly("iterations", &EditSolution::iterations);

  const auto edit = [](const Eigen::MatrixXd& zeta, const std::vector<PointConstraint>& constraints,
                       const std::optional<Eigen::MatrixXd>& fixed, double w_elastic,
                       double w_bending, const std::string& laplacian, double max_step,
                       double max_first_step) {
    return solve(problem_from(zeta, constraints, fixed, w_elastic, w_bending, laplacian, max_step,
                              max_first_step));
  };
  m.def("solve", edit, py::arg("zeta"), py::arg("constraints") = std::vector<PointConstraint>{},
        py::arg("fixed") = py::none(), py::kw_only(), py::arg("w_elastic") = 0.001,
        py::arg("w_bending") = 0.001, py::arg("laplacian") = "free_ends",
        py::arg("max_step") = std::numeric_limits<double>::infinity(),
        py::arg("max_first_step") = std::numeric_limits<double>::infinity(),
        "Minimise |L(y-zeta)|^2 + w_elastic |Ey|^2 + w_bending |Ry|^2 under the constraints.\n\n"
        "zeta: (T, d) demonstration, T >= 3. fixed: (k, d) first rows of y. max_step and\n"
        "max_first_step bound the l1 norm of the steps between nodes. Raises ValueError for an\n"
        "invalid problem; an infeasible one is a status.");
}

void bind_endpoint_solver(py::module_& m) {
  py::class_<EndpointSolver>(m, "EndpointSolver",
                             "One l1 ball on the last node, in closed form, gains built once.")
      .def(py::init([](const Eigen::MatrixXd& zeta, double w_elastic, double w_bending,
                       const std::string& laplacian) {
             return EndpointSolver(zeta, weights_from(w_elastic, w_bending, laplacian));
           }),
           py::arg("zeta"), py::kw_only(), py::arg("w_elastic") = 0.001,
           py::arg("w_bending") = 0.001, py::arg("laplacian") = "free_ends")
      .def(
          "solve",
          [](const EndpointSolver& solver, Eigen::MatrixXd plan, Eigen::Index executed,
             const Eigen::VectorXd& goal, double radius) {
            solver.solve(executed, goal, radius, plan);
            return plan;
          },
          py::arg("previous"), py::arg("executed"), py::arg("goal"), py::arg("radius") = 0.0,
          "The plan (T, d): rows [0, executed) as in previous, executed >= 2, the last row within\n"
          "radius of goal (d,).");
}

void bind_obstacles(py::module_& m) {
  py::class_<Obstacle>(m, "Obstacle", "A convex obstacle; see disc_obstacle and box_obstacle.")
      .def_readonly("centre", &Obstacle::centre, "(d,).")
      .def_readonly("radius", &Obstacle::radius, "Of a disc; 0 for a box.")
      .def_readonly("half_widths", &Obstacle::half_widths, "(d,) of a box; empty for a disc.");
  m.def("disc_obstacle", &Obstacle::disc, py::arg("centre"), py::arg("radius"),
        "Disc, in 3-D a sphere. centre: (d,).");
  m.def("box_obstacle", py::overload_cast<Eigen::VectorXd, Eigen::VectorXd>(&Obstacle::box),
        py::arg("centre"), py::arg("half_widths"), "Axis-aligned box. centre, half_widths: (d,).");
  m.def("polyline_clearance", &polyline_clearance, py::arg("y"), py::arg("obstacles"),
        "Least distance of the polyline through y (T, d) from the obstacles.");

  py::class_<AvoidanceSolution>(m, "AvoidanceSolution", "What avoid() found.")
      .def_property_readonly(
          "status", [](const AvoidanceSolution& s) { return name_of(s.status); },
          "'solved', 'not_found' (which is no proof that there is no way), or, without the "
          "obstacles\n"
          "already, 'infeasible', 'ill_posed' or 'iteration_limit'.")
      .def_readonly("message", &AvoidanceSolution::message, "Why it is not solved, one line.")
      .def_property_readonly(
          "y",
          [](const AvoidanceSolution& s) {
            return s.status == AvoidanceStatus::kSolved ? s.plan.y : Eigen::MatrixXd();
          },
          "Edited trajectory, (T, d); empty unless solved.")
      .def_property_readonly("energy", [](const AvoidanceSolution& s) { return s.plan.energy; })
      .def_property_readonly(
          "kkt_residual", [](const AvoidanceSolution& s) { return s.plan.kkt_residual; },
          "Of the last convex problem.")
      .def_readonly("clearance", &AvoidanceSolution::clearance, "Of the segments not fixed.")
      .def_readonly("last_move", &AvoidanceSolution::last_move, "Of a coordinate, last pass.")
      .def_readonly("passes", &AvoidanceSolution::passes)
      .def_readonly("choices", &AvoidanceSolution::choices, "Of sides, tried.");

  m.def(
      "avoid",
      [](const Eigen::MatrixXd& zeta, const std::vector<Obstacle>& obstacles, double clearance,
         const std::vector<PointConstraint>& constraints,
         const std::optional<Eigen::MatrixXd>& fixed, double w_elastic, double w_bending,
         const std::string& laplacian, double max_step, double max_first_step) {
        return avoid_obstacles({problem_from(zeta, constraints, fixed, w_elastic, w_bending,
                                             laplacian, max_step, max_first_step),
                                obstacles, clearance});
      },
      py::arg("zeta"), py::arg("obstacles"), py::arg("clearance"),
      py::arg("constraints") = std::vector<PointConstraint>{}, py::arg("fixed") = py::none(),
      py::kw_only(), py::arg("w_elastic") = 0.001, py::arg("w_bending") = 0.001,
      py::arg("laplacian") = "free_ends",
      py::arg("max_step") = std::numeric_limits<double>::infinity(),
      py::arg("max_first_step") = std::numeric_limits<double>::infinity(),
      "As solve(), and every segment that is not fixed keeps its distance from the obstacles: at\n"
      "least clearance > 0, in the unit of zeta. A local minimum, the best of the sides tried.");
}

// Before 2.12 pybind11 knows the arrays of numpy 1 only, and reads others out of bounds.
void require_known_numpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  const auto version = py::module_::import("numpy").attr("__version__").cast<std::string>();
  if (std::stoi(version) < 2) return;
  throw py::import_error(
      "elte_planner of the ROS workspace is for numpy 1, this Python has numpy " + version +
      "; install it here: pip install ./src/elte_planner");
#endif
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  require_known_numpy();
  m.doc() = "Elastic Laplacian trajectory editing: numpy in, numpy out. Rows are nodes.";
  bind_solver(m);
  bind_endpoint_solver(m);
  bind_obstacles(m);
  bind_planners(m);
  bind_demonstration(m);
  m.def("confidence_radius", &confidence_radius, py::arg("covariance"), py::arg("probability"),
        "Radius of the smallest l1 ball that holds the probability; covariance (d, d), d <= 3.");
  m.def(
      "shape_loss",
      [](const Eigen::MatrixXd& zeta, double w_elastic, double w_bending) {
        return shape_loss(zeta, weights_from(w_elastic, w_bending, "free_ends"));
      },
      py::arg("zeta"), py::kw_only(), py::arg("w_elastic") = 0.001, py::arg("w_bending") = 0.001,
      "How much of the shape the weights cost without any editing: 0 none, 1 a straight line.");
}

}  // namespace elte_planner
