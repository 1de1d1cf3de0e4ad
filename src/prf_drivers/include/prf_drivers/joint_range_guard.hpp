// SPDX-License-Identifier: BSD-3-Clause
// Holds the arm where a joint would come to rest beyond its bounds. Motion back inside is allowed.
#pragma once

#include <string>
#include <vector>

#include "prf_drivers/motion_guard.hpp"
#include "prf_drivers/robot_shapes.hpp"

namespace prf_drivers {

class JointRangeGuard {
 public:
  JointRangeGuard(JointRange range, std::vector<std::string> joints);
  [[nodiscard]] Allowance allow(const Intended& intended) const;

 private:
  JointRange range_;
  std::vector<std::string> joints_;
};

}  // namespace prf_drivers
