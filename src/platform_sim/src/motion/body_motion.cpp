// SPDX-License-Identifier: BSD-3-Clause
#include "body_motion.hpp"

#include <prf_core/require.hpp>
#include <stdexcept>

namespace platform_sim {
namespace {

const std::vector<std::string> kColumns{"x", "y", "z", "roll", "pitch", "yaw"};
// Beyond what a Vision 60 does on a treadmill, but for a wrong unit.
constexpr double kFarthest[] = {1.0, 1.0, 1.0, 0.7, 0.7, 3.2};    // m, rad
constexpr double kFastest[] = {3.0, 3.0, 3.0, 10.0, 10.0, 10.0};  // m/s, rad/s
constexpr double kLowest = 0.2;                                   // m

void validate(const RecordedMotion& recording) {
  if (recording.columns() != kColumns) {
    throw std::invalid_argument("the header must be time,x,y,z,roll,pitch,yaw");
  }
  const RecordedMotion::Extremes most = recording.extremes();
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    prf_core::require_between("largest " + kColumns[i], most.value[column], 0.0, kFarthest[i]);
    prf_core::require_between("largest rate of " + kColumns[i], most.velocity[column], 0.0,
                              kFastest[i]);
  }
  prf_core::require_between("lowest z", most.least[2], kLowest, kFarthest[2], "m");
}

RecordedMotion read(const std::string& csv_path) {
  RecordedMotion recording(csv_path);
  try {
    validate(recording);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(csv_path + ": " + error.what());
  }
  return recording;
}

}  // namespace

BodyMotion::BodyMotion(const std::string& csv_path) : recording_(read(csv_path)) {}

Eigen::Isometry3d BodyMotion::base_in_platform(double time) const {
  const Eigen::VectorXd at = recording_.at(time).values;
  return Eigen::Translation3d(at.head<3>()) * Eigen::AngleAxisd(at[5], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(at[4], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(at[3], Eigen::Vector3d::UnitX());
}

}  // namespace platform_sim
