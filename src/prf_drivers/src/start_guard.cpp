// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/start_guard.hpp"

#include <cmath>
#include <iomanip>
#include <prf_core/bounds.hpp>
#include <prf_core/require.hpp>
#include <sstream>
#include <utility>

namespace prf_drivers {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

void StartParams::validate(std::size_t joints) const {
  const auto count = static_cast<std::size_t>(ready.size());
  prf_core::require(count == 0 || count == joints, "ready", count,
                    "as many numbers as driver/joints, or none");
  prf_core::require(count == 0 || prf_core::is_within(ready, prf_core::kMaxJointPosition), "ready",
                    count, "finite numbers, rad");
  prf_core::require_between("start_distance", distance, 0.01, kPi, "rad");
  prf_core::require_between("start_speed", speed, 0.05, 1.0);
}

StartGuard::StartGuard(StartParams params, std::vector<std::string> joints)
    : params_(std::move(params)), joints_(std::move(joints)) {
  params_.validate(joints_.size());
}

Allowance StartGuard::allow(const Intended& intended) {
  const Eigen::VectorXd& measured = intended.measured.position;
  if (!begun_ && params_.ready.size() > 0) {
    Eigen::Index farthest = 0;
    const double away =
        (measured - params_.ready)
            .unaryExpr([](double off) { return std::abs(std::remainder(off, 2.0 * kPi)); })
            .maxCoeff(&farthest);
    if (!(away <= params_.distance)) {
      std::ostringstream text;
      text << std::fixed << std::setprecision(2) << "the arm begins near its ready posture only: "
           << joints_[static_cast<std::size_t>(farthest)] << " is " << away
           << " rad from it, must be within " << params_.distance;
      return {0.0, text.str(), true, MotionCode::kHeld};
    }
  }
  begun_ = true;
  if (free_from_ && intended.stamp >= *free_from_) return {};
  return {params_.speed, "on the way to the skill's first node", false, MotionCode::kFollows};
}

void StartGuard::goes_forward(prf_core::Stamp stamp) {
  if (!free_from_) free_from_ = stamp + params_.known_within;
}

void StartGuard::reset() {
  begun_ = false;
  free_from_.reset();
}

}  // namespace prf_drivers
