// SPDX-License-Identifier: BSD-3-Clause
#include "recorded_motion.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/table.hpp>
#include <random>
#include <stdexcept>

namespace prf_studies {
namespace {

constexpr double kLongestGap = 0.05;          // s between rows
constexpr double kFarthest = 100.0;           // m
constexpr double kLateral = 7e-5;             // m at 1 m
constexpr double kAlong = 7e-4;               // m at 1 m
constexpr double kFloor = 3e-4;               // m
constexpr double kOrientationSigma = 2.5e-3;  // rad

// Which cells of a row are what.
struct Layout {
  std::array<std::size_t, 4> own{};     // time, x, y, z
  std::vector<std::size_t> quaternion;  // x, y, z, w, or fewer
  std::vector<std::size_t> camera;      // x, y, z, or fewer
};

Layout layout_of(const prf_core::TableReader& reader, const std::array<std::string, 4>& columns) {
  Layout layout;
  for (std::size_t i = 0; i < columns.size(); ++i) layout.own[i] = reader.column(columns[i]);
  const std::string prefix = columns[1].substr(0, columns[1].size() - 1);
  for (const char* name : {"qx", "qy", "qz", "qw"}) {
    if (const auto found = reader.find(prefix + name)) layout.quaternion.push_back(*found);
  }
  for (const char* name : {"camera_x", "camera_y", "camera_z"}) {
    if (const auto found = reader.find(name)) layout.camera.push_back(*found);
  }
  return layout;
}

Eigen::Vector3d vector_at(const prf_core::TableReader& reader, const std::size_t* cells) {
  return {reader.number(cells[0]), reader.number(cells[1]), reader.number(cells[2])};
}

void take_row(const prf_core::TableReader& reader, const Layout& layout, RecordedMotion& motion) {
  const double t = reader.number(layout.own[0]);
  if (!motion.time.empty() && !(t > motion.time.back())) {
    reader.refuse("time does not rise, it is " + reader.cells()[layout.own[0]]);
  }
  const Eigen::Vector3d position = vector_at(reader, &layout.own[1]);
  if (!(position.norm() <= kFarthest)) {
    reader.refuse("the target is " + std::to_string(position.norm()) +
                  " m away, must be at most 100 m; is it in mm?");
  }
  motion.time.push_back(t);
  motion.position.push_back(position);
  if (layout.quaternion.size() == 4) {
    const Eigen::Vector3d imaginary = vector_at(reader, layout.quaternion.data());
    const Eigen::Quaterniond turn(reader.number(layout.quaternion[3]), imaginary.x(), imaginary.y(),
                                  imaginary.z());
    if (!(turn.norm() > 0.5)) reader.refuse("its quaternion is no orientation");
    motion.orientation.push_back(turn.normalized());
  }
  if (motion.time.size() > 1) return;
  motion.camera = layout.camera.size() == 3 ? vector_at(reader, layout.camera.data())
                                            : position - 0.6 * Eigen::Vector3d::UnitX();
}

// Nothing is known between rows that are far apart: with most of them so, nothing would be tracked.
void require_dense(const RecordedMotion& motion, const std::string& path) {
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < motion.time.size(); ++i) {
    if (motion.time[i] - motion.time[i - 1] > kLongestGap) ++gaps;
  }
  if (2 * gaps < motion.time.size()) return;
  throw std::invalid_argument(path + ": " + std::to_string(gaps) + " of " +
                              std::to_string(motion.time.size()) +
                              " rows are more than 0.05 s after the row before; is the time in s?");
}

}  // namespace

std::optional<prf_core::Pose> RecordedMotion::at(double t) const {
  const auto after = std::lower_bound(time.begin(), time.end(), t);
  if (after == time.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - time.begin());
  const std::size_t before = *after == t ? i : i - 1;
  if (i == 0 ? *after > t : time[i] - time[before] > kLongestGap) return std::nullopt;
  const double width = time[i] - time[before];
  const double fraction = width > 0 ? (t - time[before]) / width : 0.0;
  prf_core::Pose pose;
  pose.position = position[before] + fraction * (position[i] - position[before]);
  if (!orientation.empty()) {
    pose.orientation = orientation[before].slerp(fraction, orientation[i]);
  }
  return pose;
}

RecordedMotion read_motion(const std::string& path, const std::array<std::string, 4>& columns) {
  std::ifstream file = prf_core::open_table(path);
  prf_core::TableReader reader(file, path);
  reader.read_header(columns[0] + "," + columns[1] + "," + columns[2] + "," + columns[3]);
  const Layout layout = layout_of(reader, columns);
  RecordedMotion motion;
  while (reader.next()) take_row(reader, layout, motion);
  if (motion.time.size() < 2) throw std::invalid_argument(path + ": has fewer than 2 rows");
  require_dense(motion, path);
  return motion;
}

std::vector<Image> simulate_images(const RecordedMotion& motion, double rate, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<Image> images;
  const double start = motion.time.front();
  for (int frame = 0;; ++frame) {
    const std::chrono::milliseconds since(std::llround(frame * 1000.0 / rate));
    const double t = start + prf_core::to_seconds(since);
    if (t > motion.time.back()) return images;
    Image image{since, {}};
    if (const auto truth = motion.at(t)) {
      const Eigen::Vector3d view = truth->position - motion.camera;
      const double growth = view.squaredNorm();
      const Eigen::Vector3d along = view.normalized();
      prf_predictor::TagMeasurement measurement;
      measurement.position_covariance =
          (std::pow(kLateral * growth, 2) + kFloor * kFloor) * Eigen::Matrix3d::Identity() +
          (std::pow(kAlong * growth, 2) - std::pow(kLateral * growth, 2)) * along *
              along.transpose();
      const Eigen::Matrix3d root = measurement.position_covariance.llt().matrixL();
      const double x = normal(random);
      const double y = normal(random);
      measurement.position = truth->position + root * Eigen::Vector3d(x, y, normal(random));
      Eigen::Vector3d rotation;
      for (double& angle : rotation) angle = kOrientationSigma * normal(random);
      measurement.orientation = prf_core::exp_so3(rotation) * truth->orientation;
      measurement.orientation_covariance =
          std::pow(kOrientationSigma, 2) * Eigen::Matrix3d::Identity();
      image.measurements.push_back(measurement);
    }
    images.push_back(image);
  }
}

}  // namespace prf_studies
