// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/effort_guard.hpp"

#include <iomanip>
#include <prf_core/require.hpp>
#include <sstream>
#include <utility>

namespace prf_drivers {
namespace {

constexpr double kMaxEffort = 1e5;  // N m, beyond any arm

}  // namespace

void EffortParams::validate(std::size_t joints) const {
  prf_core::require_between("effort_patience", patience, 0.0, 1.0, "s");
  for (const auto* bound : {&lower, &upper}) {
    const auto count = static_cast<std::size_t>(bound->size());
    prf_core::require(count == 0 || count == joints, "effort_lower and effort_upper", count,
                      "as many numbers as driver/joints, or none");
  }
  prf_core::require(lower.size() == upper.size(), "effort_lower", lower.size(),
                    "as many numbers as effort_upper");
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    prf_core::require_between("effort_lower", lower[i], -kMaxEffort, kMaxEffort, "N m");
    prf_core::require_between("effort_upper", upper[i], -kMaxEffort, kMaxEffort, "N m");
    prf_core::require(lower[i] < upper[i], "effort_lower", lower[i], "below effort_upper");
  }
}

EffortGuard::EffortGuard(EffortParams params, std::vector<std::string> joints)
    : params_(std::move(params)), joints_(std::move(joints)) {
  params_.validate(joints_.size());
}

std::string EffortGuard::excess(const Eigen::VectorXd& effort) const {
  if (effort.size() != params_.lower.size()) return "the driver tells no efforts";
  for (Eigen::Index i = 0; i < effort.size(); ++i) {
    if (effort[i] >= params_.lower[i] && effort[i] <= params_.upper[i]) continue;
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << "the effort of "
         << joints_[static_cast<std::size_t>(i)] << " is " << effort[i]
         << " N m, in free motion it is within [" << params_.lower[i] << ", " << params_.upper[i]
         << "]";
    return text.str();
  }
  return "";
}

Allowance EffortGuard::allow(const Intended& intended) {
  if (params_.lower.size() == 0) return {};
  if (stopped_.empty()) {
    const std::string why = excess(intended.measured.effort);
    if (why.empty()) {
      since_.reset();
    } else {
      if (!since_) since_ = intended.stamp;
      if (prf_core::to_seconds(intended.stamp - *since_) >= params_.patience) {
        stopped_ = "protective stop, until the service ~reset is called: " + why;
      }
    }
  }
  if (stopped_.empty()) return {};
  return {0.0, stopped_, true, MotionCode::kProtectiveStop};
}

void EffortGuard::reset() {
  since_.reset();
  stopped_.clear();
}

}  // namespace prf_drivers
