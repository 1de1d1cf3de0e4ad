// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "elte_planner/combine_demonstrations.hpp"
#include "elte_planner/demonstration.hpp"
#include "elte_planner/demonstration_limits.hpp"

namespace py = pybind11;

namespace elte_planner {
namespace {

Pose pose_from_row(const Eigen::Matrix<double, 7, 1>& row) {
  return {row.head<3>(), Eigen::Quaterniond(row[6], row[3], row[4], row[5])};
}

Eigen::Matrix<double, 7, 1> row_from(const Pose& pose) {
  Eigen::Matrix<double, 7, 1> row;
  row << pose.position, pose.orientation.coeffs();
  return row;
}

Eigen::Matrix<double, Eigen::Dynamic, 7> rows_from(const Demonstration& demonstration) {
  const auto& samples = demonstration.samples();
  Eigen::Matrix<double, Eigen::Dynamic, 7> rows(samples.size(), 7);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = row_from(samples[i].pose).transpose();
  }
  return rows;
}

Demonstration demonstration_from(const Eigen::VectorXd& times, const Eigen::MatrixXd& positions,
                                 const Eigen::MatrixXd& quaternions, const std::string& frame,
                                 const std::string& child_frame,
                                 const Eigen::Matrix<double, 7, 1>& target,
                                 const Demonstration::Notes& notes) {
  const Eigen::Index count = times.size();
  if (positions.rows() != count || positions.cols() != 3 || quaternions.rows() != count ||
      quaternions.cols() != 4) {
    throw std::invalid_argument(
        "demonstration has " + std::to_string(count) + " times, positions " +
        std::to_string(positions.rows()) + " x " + std::to_string(positions.cols()) +
        " and quaternions " + std::to_string(quaternions.rows()) + " x " +
        std::to_string(quaternions.cols()) + ", must be as many, x 3 and x 4");
  }
  std::vector<TimedPose> samples;
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Matrix<double, 7, 1> row;
    row << positions.row(i).transpose(), quaternions.row(i).transpose();
    samples.push_back({times[i], pose_from_row(row)});
  }
  return Demonstration(std::move(samples), frame, child_frame, pose_from_row(target), notes);
}

}  // namespace

void bind_demonstration(py::module_& m) {
  py::class_<Demonstration>(m, "Demonstration", "Timed poses of a demonstrated skill.")
      .def(
          py::init(&demonstration_from), py::arg("times"), py::arg("positions"),
          py::arg("quaternions"), py::arg("frame"), py::arg("child_frame"), py::arg("target"),
          py::arg("notes") = Demonstration::Notes{},
          "times: (N,), s from 0. positions: (N, 3), m. quaternions: (N, 4), x y z w. target:\n"
          "(7,), position and quaternion of the target in frame. notes: further lines of the file.")
      .def_property_readonly(
          "target", [](const Demonstration& d) { return row_from(d.target()); },
          "(7,), x y z qx qy qz qw.")
      .def_property_readonly(
          "goal_in_target", [](const Demonstration& d) { return row_from(d.goal_in_target()); },
          "(7,), last pose in the target's frame.")
      .def_property_readonly("notes", &Demonstration::notes,
                             "dict of the other lines `# key: value`.")
      .def_property_readonly("frame", &Demonstration::frame)
      .def_property_readonly("child_frame", &Demonstration::child_frame)
      .def_property_readonly("positions", &Demonstration::positions, "(N, 3), m.")
      .def_property_readonly(
          "times",
          [](const Demonstration& demonstration) {
            const auto& samples = demonstration.samples();
            Eigen::VectorXd times(static_cast<Eigen::Index>(samples.size()));
            for (std::size_t i = 0; i < samples.size(); ++i) {
              times[static_cast<Eigen::Index>(i)] = samples[i].time;
            }
            return times;
          },
          "(N,), s from the start.")
      .def_property_readonly(
          "quaternions",
          [](const Demonstration& d) { return Eigen::MatrixXd(rows_from(d).rightCols<4>()); },
          "(N, 4), x y z w.")
      .def_property_readonly("poses", &rows_from, "(N, 7), x y z qx qy qz qw.")
      .def("resampled_by_arc_length", &Demonstration::resampled_by_arc_length, py::arg("nodes"),
           "nodes samples equally spaced along the path.")
      .def("resampled_by_douglas_peucker", &Demonstration::resampled_by_douglas_peucker,
           py::arg("nodes"), "The nodes samples that keep the shape best, as demonstrated.")
      .def("thinned_by_douglas_peucker", &Demonstration::thinned_by_douglas_peucker,
           py::arg("tolerance"),
           "The samples that leave none farther than tolerance, m, from the lines between them.");
  m.def(
      "combine",
      [](const std::vector<Demonstration>& demonstrations, std::size_t nodes,
         const std::string& alignment) {
        if (alignment != "arc_length" && alignment != "dynamic_time_warping") {
          throw std::invalid_argument("alignment is '" + alignment +
                                      "', must be 'arc_length' or 'dynamic_time_warping'");
        }
        return combined(
            demonstrations, nodes,
            alignment == "arc_length" ? Alignment::kArcLength : Alignment::kDynamicTimeWarping);
      },
      py::arg("demonstrations"), py::arg("nodes"), py::kw_only(),
      py::arg("alignment") = "arc_length",
      "The mean of several demonstrations of one skill, relative to their targets, as one.");
  m.def(
      "require_executable",
      [](const Demonstration& demonstration, double reach) {
        DemonstrationLimits limits;
        limits.reach = reach;
        limits.validate();
        require_executable(demonstration, limits);
      },
      py::arg("demonstration"), py::arg("reach"),
      "Raises ValueError, with the row, for a demonstration that an arm cannot have made or cannot "
      "follow: farther than `reach` (m) from the origin of its frame, faster, with holes. The node "
      "asks the same.");
  m.def("load_demonstration", &load_demonstration, py::arg("path"),
        "Read the CSV form; raises ValueError with file, line, column, value and bound.");
  m.def(
      "save_demonstration", &save_demonstration, py::arg("demonstration"), py::arg("path"),
      "Write the CSV form: times in microseconds, poses to nine decimals. Raises ValueError when\n"
      "it cannot be written or would not be read back.");
}

}  // namespace elte_planner
