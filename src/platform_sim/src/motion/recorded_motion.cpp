// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/recorded_motion.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/quoted.hpp>
#include <prf_core/table.hpp>
#include <stdexcept>
#include <utility>

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTurnDuration = 1.0;  // s, of the speed of playing from 0 to 1
constexpr Eigen::Index kFewestRows = 4;
// Beyond these the spline's second derivatives are numbers without meaning.
constexpr double kLargestValue = 1e4;   // m or rad
constexpr double kLatestTime = 1e10;    // s, the seconds since 1970 included
constexpr double kShortestStep = 1e-4;  // s
constexpr double kLongestStep = 2.0;    // s; longer ones are in another unit, or no motion

struct Table {
  std::vector<std::string> columns;  // the first one is time
  std::vector<std::vector<double>> rows;
};

std::vector<double> read_row(const prf_core::TableReader& reader,
                             const std::vector<std::vector<double>>& before) {
  const std::size_t count = reader.columns().size();
  const std::vector<std::string>& words = reader.cells();
  if (words.size() != count) {
    reader.refuse(std::to_string(words.size()) + " values, must be " + std::to_string(count));
  }
  std::vector<double> row;
  for (std::size_t i = 0; i < count; ++i) {
    row.push_back(reader.number(i));
    if (std::abs(row[i]) > (i == 0 ? kLatestTime : kLargestValue)) {
      reader.refuse(reader.columns()[i] + " = " + words[i] + ", is beyond every bound");
    }
  }
  if (before.empty()) return row;
  const double step = row[0] - before.back()[0];
  if (!(step > 0.0)) {
    reader.refuse("time = " + words[0] + ", must be above the row before's " +
                  std::to_string(before.back()[0]));
  }
  if (step < kShortestStep || step > kLongestStep) {
    reader.refuse("time = " + words[0] + ", must be 0.0001 .. 2 s after the row before's " +
                  std::to_string(before.back()[0]) + "; is it in s?");
  }
  return row;
}

Table read_table(const std::string& path) {
  std::ifstream file = prf_core::open_table(path);
  prf_core::TableReader reader(file, path);
  reader.read_header("time,<name>,...");
  Table table{reader.columns(), {}};
  if (table.columns.size() < 2 || table.columns[0] != "time") {
    reader.refuse("the header is " + prf_core::quoted(reader.text()) + ", must be time,<name>,...");
  }
  while (reader.next()) table.rows.push_back(read_row(reader, table.rows));
  if (table.rows.size() < static_cast<std::size_t>(kFewestRows) ||
      table.rows.back()[0] - table.rows.front()[0] < kTurnDuration) {
    throw std::invalid_argument(path + " is too short, must have 4 rows over 1 s");
  }
  return table;
}

// Second derivatives m of the natural cubic spline through rows of y:
//   h_{i-1} m_{i-1} + 2 (h_{i-1} + h_i) m_i + h_i m_{i+1} = 6 ((y_{i+1} - y_i)/h_i -
//   (y_i - y_{i-1})/h_{i-1}),  m_0 = m_n = 0, by elimination.
Eigen::MatrixXd spline_curvatures(const std::vector<double>& t, const Eigen::MatrixXd& y) {
  const Eigen::Index n = y.rows();
  const auto time = [&](Eigen::Index i) { return t[static_cast<std::size_t>(i)]; };
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, y.cols());
  Eigen::VectorXd upper = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double before = time(i) - time(i - 1);
    const double after = time(i + 1) - time(i);
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    right.row(i) = (6.0 * ((y.row(i + 1) - y.row(i)) / after - (y.row(i) - y.row(i - 1)) / before) -
                    before * right.row(i - 1)) /
                   pivot;
  }
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, y.cols());
  for (Eigen::Index i = n - 2; i > 0; --i) m.row(i) = right.row(i) - upper[i] * m.row(i + 1);
  return m;
}

// Way and speed of playing, u s after it began to rise.
std::pair<double, double> rise(double u) {
  const double angle = kPi * u / kTurnDuration;
  return {0.5 * u - 0.5 * kTurnDuration / kPi * std::sin(angle), 0.5 * (1.0 - std::cos(angle))};
}

// Place in a recording of the given length and speed of playing.
std::pair<double, double> play(double time, double length) {
  if (time <= 0.0) return {0.0, 0.0};
  const double pass = length + kTurnDuration;  // once through, both turns included
  const double into = std::fmod(time, 2.0 * pass);
  const bool backward = into > pass;
  const double u = backward ? into - pass : into;
  std::pair<double, double> played;
  if (u < kTurnDuration) {
    played = rise(u);
  } else if (u < length) {
    played = {0.5 * kTurnDuration + u - kTurnDuration, 1.0};
  } else {
    const auto [rest, speed] = rise(pass - u);
    played = {length - rest, speed};
  }
  if (!backward) return played;
  return {length - played.first, -played.second};
}

}  // namespace

RecordedMotion::RecordedMotion(const std::string& csv_path) {
  const Table table = read_table(csv_path);
  columns_.assign(table.columns.begin() + 1, table.columns.end());
  values_.resize(static_cast<Eigen::Index>(table.rows.size()),
                 static_cast<Eigen::Index>(columns_.size()));
  for (const std::vector<double>& row : table.rows) {
    const auto index = static_cast<Eigen::Index>(times_.size());
    times_.push_back(row[0] - table.rows[0][0]);
    values_.row(index) = Eigen::Map<const Eigen::RowVectorXd>(row.data() + 1, values_.cols());
  }
  curvatures_ = spline_curvatures(times_, values_);
}

RecordedMotion::Sample RecordedMotion::interpolate(double time) const {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
  const Eigen::Index i = after - times_.begin() - 1;
  const double h = *after - *(after - 1);
  const double a = (*after - time) / h;
  const double b = 1.0 - a;
  const auto y0 = values_.row(i), y1 = values_.row(i + 1);
  const auto m0 = curvatures_.row(i), m1 = curvatures_.row(i + 1);
  Sample sample;
  sample.values = (a * y0 + b * y1 + h * h / 6.0 * ((a * a * a - a) * m0 + (b * b * b - b) * m1));
  sample.velocities =
      ((y1 - y0) / h + h / 6.0 * ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0));
  return sample;
}

RecordedMotion::Sample RecordedMotion::at(double time) const {
  const auto [place, speed] = play(time, times_.back());
  Sample sample = interpolate(place);
  sample.velocities *= speed;
  return sample;
}

RecordedMotion::Extremes RecordedMotion::extremes() const {
  Extremes largest;
  largest.value = values_.cwiseAbs().colwise().maxCoeff();
  largest.least = values_.colwise().minCoeff();
  largest.acceleration = curvatures_.cwiseAbs().colwise().maxCoeff();
  largest.velocity = Eigen::VectorXd::Zero(values_.cols());
  for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
    for (const double time : {times_[i], 0.5 * (times_[i] + times_[i + 1])}) {
      largest.velocity = largest.velocity.cwiseMax(interpolate(time).velocities.cwiseAbs());
    }
  }
  return largest;
}

}  // namespace platform_sim
