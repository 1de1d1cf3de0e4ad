// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/clearance_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/require.hpp>
#include <sstream>
#include <utility>

namespace prf_drivers {
namespace {

constexpr double kFarthest = 10.0;  // m, of a box's corner from the arm's base
constexpr double kAway = 1e-6;      // m, by which the distance must grow

Allowance allowed(const ClearanceParams& params, const std::string& what, double now, double rest) {
  if (rest > now + kAway || rest >= params.slow_distance) return {};
  std::ostringstream text;
  // Whole millimetres: nearly the same words at each tick.
  text << what << " would be " << std::lround(1e3 * rest) << " mm apart";
  if (!(rest >= params.stop_distance)) {
    return {0.0, text.str(), true, MotionCode::kHaltsForCollision};
  }
  const double share =
      (rest - params.stop_distance) / (params.slow_distance - params.stop_distance);
  return {kLeastSpeed + (1.0 - kLeastSpeed) * share, text.str(), false,
          MotionCode::kSlowsForCollision};
}

ClearanceParams validated(ClearanceParams params) {
  params.validate();
  return params;
}

}  // namespace

void ClearanceParams::validate() const {
  prf_core::require_between("stop_distance", stop_distance, 0.0, 0.5, "m");
  prf_core::require_between("slow_distance", slow_distance, stop_distance, 1.0, "m");
  prf_core::require(slow_distance > stop_distance, "slow_distance", slow_distance,
                    "above stop_distance");
}

Allowance allowed_by(const ClearanceParams& params, const Clearances& now, const Clearances& rest) {
  Allowance slowest;
  for (const auto& [what, distance] : rest) {
    const auto before = now.find(what);
    const double none = std::numeric_limits<double>::infinity();
    Allowance found = allowed(params, what, before == now.end() ? none : before->second, distance);
    if (found.hold) return found;
    if (found.speed < slowest.speed) slowest = found;
  }
  return slowest;
}

SelfCollisionGuard::SelfCollisionGuard(RobotShapes shapes, const Eigen::VectorXd& ready,
                                       ClearanceParams params)
    : shapes_(std::move(shapes)), params_(validated(params)) {
  shapes_.place(ready, {});
  ignored_ = shapes_.ignore_nearer_than(params_.stop_distance);
}

Allowance SelfCollisionGuard::allow(const Intended& intended) {
  shapes_.place(intended.rest, intended.measured.elsewhere);
  const Clearances rest = shapes_.between_bodies(params_.slow_distance);
  if (rest.empty()) return {};
  shapes_.place(intended.measured.position, intended.measured.elsewhere);
  return allowed_by(params_, shapes_.between_bodies(params_.slow_distance), rest);
}

BoxGuard::BoxGuard(RobotShapes shapes, std::optional<Box> workspace, std::vector<Box> forbidden,
                   ClearanceParams params)
    : shapes_(std::move(shapes)),
      workspace_(std::move(workspace)),
      forbidden_(std::move(forbidden)),
      params_(validated(params)) {}

Clearances BoxGuard::clearances(const Eigen::VectorXd& arm, const Measured& measured) {
  shapes_.place(arm, measured.elsewhere);
  Clearances found;
  if (workspace_) found = shapes_.inside(*workspace_, params_.slow_distance);
  for (std::size_t i = 0; i < forbidden_.size(); ++i) {
    const std::string name = "forbidden box " + std::to_string(i + 1);
    found.merge(shapes_.outside(forbidden_[i], name, params_.slow_distance));
  }
  return found;
}

Allowance BoxGuard::allow(const Intended& intended) {
  const Clearances rest = clearances(intended.rest, intended.measured);
  if (rest.empty()) return {};
  return allowed_by(params_, clearances(intended.measured.position, intended.measured), rest);
}

std::vector<Box> boxes_from(const std::string& name, const std::vector<double>& numbers) {
  prf_core::require(numbers.size() % 6 == 0, name, std::to_string(numbers.size()) + " numbers",
                    "six a box: lower corner, upper corner");
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < numbers.size(); i += 6) {
    for (std::size_t k = 0; k < 6; ++k) {
      prf_core::require_between(name, numbers[i + k], -kFarthest, kFarthest, "m");
    }
    const Eigen::Map<const Eigen::Vector3d> lower(&numbers[i]);
    const Eigen::Map<const Eigen::Vector3d> upper(&numbers[i + 3]);
    for (Eigen::Index k = 0; k < 3; ++k) {
      prf_core::require(lower[k] < upper[k], name, lower[k], "below the upper corner");
    }
    boxes.push_back({lower, upper});
  }
  return boxes;
}

}  // namespace prf_drivers
