// SPDX-License-Identifier: BSD-3-Clause
// The true path of a target, and the measurements that a camera would give of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <prf_core/se3.hpp>
#include <prf_core/time.hpp>

#include "prf_predictor/tag_measurement.hpp"

namespace prf_studies {

struct RecordedMotion {
  std::vector<double> time;  // s, rising
  std::vector<Eigen::Vector3d> position;
  std::vector<Eigen::Quaterniond> orientation;  // perhaps none
  Eigen::Vector3d camera = Eigen::Vector3d::Zero();

  // By interpolation; nothing outside of the recording or in a gap.
  [[nodiscard]] std::optional<prf_core::Pose> at(double t) const;
};

// A table of prf_core/table.hpp. `columns` are the names of time, x, y and z. Columns
// with qx, qy, qz and qw in place of the x of that name are the orientation, if there are any. The
// camera is at camera_x, camera_y, camera_z of the first row, else 0.6 m before the target. Throws
// std::invalid_argument with file and reason; also for millimetres and for a time that is not in s.
[[nodiscard]] RecordedMotion read_motion(const std::string& path,
                                         const std::array<std::string, 4>& columns);

struct Image {
  prf_core::Stamp stamp{0};
  std::vector<prf_predictor::TagMeasurement> measurements;
};

// Measurements as a detector of prf_perception's accuracy gives them of a tag of 0.1 m, `rate`
// images a second. At a distance of d metres the standard deviation is 0.07 mm d^2 across and 0.7
// mm d^2 along the view ray, each with 0.3 mm added in quadrature. Orientations have 2.5 mrad about
// each axis. The noise is drawn from the covariance that is reported.
[[nodiscard]] std::vector<Image> simulate_images(const RecordedMotion& motion, double rate,
                                                 std::uint32_t seed);

}  // namespace prf_studies
