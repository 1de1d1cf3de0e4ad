// SPDX-License-Identifier: BSD-3-Clause
// The true path of a target, and how a camera would have seen it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {

struct RecordedMotion {
  std::vector<double> time;  // s, rising
  std::vector<Eigen::Vector3d> position;
  std::vector<Eigen::Quaterniond> orientation;  // perhaps none
  Eigen::Vector3d camera = Eigen::Vector3d::Zero();

  struct Pose {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  };
  // By interpolation; nothing outside or in a gap.
  [[nodiscard]] std::optional<Pose> at(double t) const;
};

// CSV with lines of comment (#) and a header; `columns` are the names of time, x, y and z. Where
// the name of x ends so and there are columns of the same names with qx, qy, qz and qw, they are
// the orientation. The camera is where camera_x, camera_y, camera_z of the first row say, else 0.6
// m before the target. Throws std::invalid_argument with file and reason.
[[nodiscard]] RecordedMotion read_motion(const std::string& path,
                                         const std::array<std::string, 4>& columns);

struct Sighting {
  Nanoseconds stamp = 0;
  std::vector<TagMeasurement> sights;
};

// What a detector of prf_perception's accuracy reports of a tag of 0.1 m at `rate` images a
// second: seen d metres away, d = 1 standing for 0.07 mm across and 0.7 mm along the line of
// sight, growing with d^2, and 0.3 mm that no view undercuts. The noise is drawn from the
// covariance that is reported. Orientations have a noise of 2.5 mrad about each axis.
[[nodiscard]] std::vector<Sighting> see(const RecordedMotion& motion, double rate,
                                        std::uint32_t seed);

}  // namespace prf_predictor
