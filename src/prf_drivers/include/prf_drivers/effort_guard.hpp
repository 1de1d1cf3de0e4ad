// SPDX-License-Identifier: BSD-3-Clause
// Protective stop: the effort of a joint leaves the bounds that were learnt in free motion for
// longer than `patience`. It stays until reset().
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "prf_drivers/motion_guard.hpp"

namespace prf_drivers {

struct EffortParams {
  Eigen::VectorXd lower;  // N m; empty: efforts are not looked at
  Eigen::VectorXd upper;
  double patience = 0.0;  // s, 0 to 1

  void validate(std::size_t joints) const;
};

class EffortGuard {
 public:
  EffortGuard(EffortParams params, std::vector<std::string> joints);

  [[nodiscard]] Allowance allow(const Intended& intended);
  void reset();

 private:
  // What is wrong at this tick; empty: nothing.
  [[nodiscard]] std::string excess(const Eigen::VectorXd& effort) const;

  EffortParams params_;
  std::vector<std::string> joints_;
  std::optional<prf_core::Stamp> since_;
  std::string stopped_;
};

}  // namespace prf_drivers
