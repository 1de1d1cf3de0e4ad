// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <cmath>
#include <limits>
#include <prf_core/require.hpp>
#include <prf_core/se3.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "bindings.hpp"
#include "elte_planner/orientation_blend.hpp"
#include "elte_planner/skill_planner.hpp"

namespace py = pybind11;

namespace elte_planner {
namespace {

const char* name_of(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return "solved";
    case PlanStatus::kRelaxed:
      return "relaxed";
    case PlanStatus::kFailed:
    case PlanStatus::kNoWay:
      break;
  }
  return "failed";
}

using Quaternions = Eigen::Matrix<double, Eigen::Dynamic, 4>;   // rows x y z w
using Via = std::tuple<Eigen::Index, Eigen::VectorXd, double>;  // node, centre, radius

std::vector<Eigen::Quaterniond> quaternions_from(const Quaternions& rows, const char* name) {
  std::vector<Eigen::Quaterniond> result;
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    const Eigen::Quaterniond quaternion(Eigen::Vector4d(rows.row(k)));
    const double error = std::abs(quaternion.norm() - 1.0);
    prf_core::require(error <= prf_core::kUnitQuaternionTolerance, name, rows.row(k),
                      "rows x y z w of unit length");
    result.push_back(quaternion.normalized());
  }
  return result;
}

Quaternions blended(const Quaternions& demonstrated, const Quaternions& previous,
                    Eigen::Index frozen, const Quaternions& goals) {
  const auto blend = blend_orientations(quaternions_from(demonstrated, "demonstrated"),
                                        quaternions_from(previous, "previous"), frozen,
                                        quaternions_from(goals, "goals"));
  Quaternions rows(blend.size(), 4);
  for (std::size_t k = 0; k < blend.size(); ++k) {
    rows.row(static_cast<Eigen::Index>(k)) = blend[k].coeffs().transpose();
  }
  return rows;
}

}  // namespace

void bind_planners(py::module_& m) {
  py::class_<PlanResult>(m, "PlanResult", "What SkillPlanner.plan() found.")
      .def_property_readonly(
          "status", [](const PlanResult& result) { return name_of(result.status); },
          "'solved', 'relaxed' (the radius was enlarged by slack) or 'failed'.")
      .def_readonly("message", &PlanResult::message, "Why it is not solved, one line.")
      .def_readonly("positions", &PlanResult::positions, "(T, d); empty when failed.")
      .def_readonly("kkt_residual", &PlanResult::kkt_residual,
                    "In the unit of the positions; 0 for planners without one.")
      .def_readonly("slack", &PlanResult::slack, "Added to the radius, in the unit of positions.");
  py::class_<SkillPlanner>(m, "SkillPlanner", "A planner of one demonstration, built once.")
      .def(py::init([](const std::string& planner, const Eigen::MatrixXd& zeta, double w_elastic,
                       double w_bending, double max_step) {
             return make_skill_planner(planner, zeta,
                                       weights_from(w_elastic, w_bending, "free_ends"),
                                       SolveLimits{max_step});
           }),
           py::arg("planner"), py::arg("zeta"), py::kw_only(), py::arg("w_elastic") = 0.001,
           py::arg("w_bending") = 0.001,
           py::arg("max_step") = std::numeric_limits<double>::infinity(),
           "planner: one of planner_names(). zeta: (T, d), T >= 3. max_step: greatest l1 distance\n"
           "of consecutive nodes; only elte and lte keep one.")
      .def(
          "plan",
          [](SkillPlanner& planner, const Eigen::MatrixXd& previous, Eigen::Index frozen,
             const Eigen::VectorXd& goal, double radius, const std::vector<Via>& via) {
            PlanRequest request{previous, frozen, goal, radius};
            for (const auto& [node, centre, ball] : via) {
              request.approach.push_back({node, centre, ball});
            }
            return planner.plan(request);
          },
          py::arg("previous"), py::arg("frozen"), py::arg("goal"), py::arg("radius") = 0.0,
          py::arg("via") = std::vector<Via>{},
          "Rows [0, frozen) as in previous (T, d), 2 <= frozen <= T; the last row within the l1\n"
          "radius of goal (d,); via: (node, centre (d,), l1 radius) of free nodes, which only "
          "elte\n"
          "and lte keep.");
  m.def("planner_names", &planner_names,
        "What SkillPlanner and the node's parameter planner may name.");
  m.def("blend_orientations", &blended, py::arg("demonstrated"), py::arg("previous"),
        py::arg("frozen"), py::arg("goals"),
        "Quaternions (T, 4), x y z w: rows [0, frozen) as in previous, the last ones as goals (n, "
        "4),\n"
        "between them the demonstrated ones turned by a correction that moves along a geodesic.");
}

}  // namespace elte_planner
