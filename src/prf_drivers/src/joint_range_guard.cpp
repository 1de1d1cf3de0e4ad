// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/joint_range_guard.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prf_drivers {
namespace {

constexpr double kTurn = 6.28318530717958647692;
constexpr double kSmall = 1e-6;  // rad

// How far a joint is outside, rad, in the turn nearest to the middle of its bounds.
double outside(double position, double lower, double upper) {
  if (!std::isfinite(lower) || !std::isfinite(upper)) return 0.0;
  const double middle = 0.5 * (lower + upper);
  return std::abs(std::remainder(position - middle, kTurn)) - 0.5 * (upper - lower);
}

}  // namespace

JointRangeGuard::JointRangeGuard(JointRange range, std::vector<std::string> joints)
    : range_(std::move(range)), joints_(std::move(joints)) {}

Allowance JointRangeGuard::allow(const Intended& intended) const {
  for (Eigen::Index i = 0; i < intended.rest.size(); ++i) {
    const double rest = outside(intended.rest[i], range_.lower[i], range_.upper[i]);
    const double now = outside(intended.measured.position[i], range_.lower[i], range_.upper[i]);
    if (rest <= kSmall || rest < now - kSmall) continue;
    return {0.0, joints_[static_cast<std::size_t>(i)] + " would leave its bounds", true,
            MotionCode::kJointBound};
  }
  return {};
}

}  // namespace prf_drivers
