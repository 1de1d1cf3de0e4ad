// SPDX-License-Identifier: BSD-3-Clause
#include "recorded_motion.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

namespace prf_studies {
namespace {

constexpr double kLongestGap = 0.05;          // s between rows
constexpr double kLateral = 7e-5;             // m at 1 m
constexpr double kAlong = 7e-4;               // m at 1 m
constexpr double kFloor = 3e-4;               // m
constexpr double kOrientationSigma = 2.5e-3;  // rad

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::optional<std::size_t> find(const std::vector<std::string>& header, const std::string& name) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
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
  std::ifstream file(path);
  if (!file) throw std::invalid_argument(path + " cannot be read");
  RecordedMotion motion;
  std::array<std::size_t, 4> own{};
  std::vector<std::size_t> camera;
  std::vector<std::size_t> quaternion;
  std::size_t count = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    const auto cells = cells_of(line);
    if (count == 0) {
      count = cells.size();
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto found = find(cells, columns[i]);
        if (!found) throw std::invalid_argument(path + " has no column " + columns[i]);
        own[i] = *found;
      }
      const std::string prefix = columns[1].substr(0, columns[1].size() - 1);
      for (const char* name : {"qx", "qy", "qz", "qw"}) {
        if (const auto found = find(cells, prefix + name)) quaternion.push_back(*found);
      }
      for (const char* name : {"camera_x", "camera_y", "camera_z"}) {
        if (const auto found = find(cells, name)) camera.push_back(*found);
      }
      continue;
    }
    try {
      const auto number = [&](std::size_t i) { return std::stod(cells.at(i)); };
      const double t = number(own[0]);
      if (!motion.time.empty() && !(t > motion.time.back())) {
        throw std::invalid_argument("time does not rise");
      }
      motion.time.push_back(t);
      motion.position.emplace_back(number(own[1]), number(own[2]), number(own[3]));
      if (quaternion.size() == 4) {
        motion.orientation.push_back(
            Eigen::Quaterniond(number(quaternion[3]), number(quaternion[0]), number(quaternion[1]),
                               number(quaternion[2]))
                .normalized());
      }
      if (motion.time.size() > 1) continue;
      motion.camera = camera.size() == 3
                          ? Eigen::Vector3d(number(camera[0]), number(camera[1]), number(camera[2]))
                          : motion.position[0] - 0.6 * Eigen::Vector3d::UnitX();
    } catch (const std::exception& error) {
      throw std::invalid_argument(path + ", row " + std::to_string(motion.time.size() + 1) + ": " +
                                  error.what());
    }
  }
  if (motion.time.size() < 2) throw std::invalid_argument(path + " has fewer than 2 rows");
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
