// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace platform_sim {

/// Motion read from a CSV file: lines that begin with # are skipped, then a header
/// `time,<name>,...` and rows of numbers; time in s, rising, at least 4 rows over at least 1 s.
/// Cubic splines go through the values, so position, velocity and acceleration are continuous.
///
/// A recording is played to its end, back to its start and so on without end. At the beginning and
/// around each turn the speed of playing changes between 0 and +-1 in 1 s as a raised cosine.
class RecordedMotion {
 public:
  /// Throws std::invalid_argument with file, line and what is wrong.
  explicit RecordedMotion(const std::string& csv_path);

  /// In the order of the file, without time.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }

  struct Sample {
    Eigen::VectorXd values;
    Eigen::VectorXd velocities;
  };
  /// At `time` s after playing began; before that the first row at rest.
  [[nodiscard]] Sample at(double time) const;

  /// Per column, played at full speed: largest magnitudes of value, velocity and acceleration, and
  /// the least (signed) value.
  struct Extremes {
    Eigen::VectorXd value, velocity, acceleration, least;
  };
  [[nodiscard]] Extremes extremes() const;

 private:
  [[nodiscard]] Sample interpolate(double time) const;

  std::vector<std::string> columns_;
  std::vector<double> times_;  // the first one is 0
  Eigen::MatrixXd values_;     // one row per time
  Eigen::MatrixXd curvatures_;
};

}  // namespace platform_sim
