// SPDX-License-Identifier: BSD-3-Clause
// Motion begins near the ready posture only, and slowly until the execution goes forward from the
// skill's first node. The same after a reset.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "prf_drivers/motion_guard.hpp"

namespace prf_drivers {

struct StartParams {
  Eigen::VectorXd ready;               // rad; empty: begins anywhere
  double distance = 0.0;               // rad, 0.01 to pi; of each joint from the ready posture
  double speed = 0.0;                  // share of the velocity limits until then, 0.05 to 1
  prf_core::Duration known_within{0};  // from a tick until what the execution did is known

  // `joints`: how many the arm has.
  void validate(std::size_t joints) const;
};

class StartGuard {
 public:
  StartGuard(StartParams params, std::vector<std::string> joints);

  [[nodiscard]] Allowance allow(const Intended& intended);
  // The execution goes forward at this tick. It counts `known_within` later, so that the result
  // does not depend on the order in which topics arrive.
  void goes_forward(prf_core::Stamp stamp);
  void reset();

 private:
  StartParams params_;
  std::vector<std::string> joints_;
  bool begun_ = false;
  std::optional<prf_core::Stamp> free_from_;
};

}  // namespace prf_drivers
