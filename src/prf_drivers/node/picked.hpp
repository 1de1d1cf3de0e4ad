// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace prf_drivers {

// Values of `joints` in their order; none: a joint is not named, or has no value.
inline std::optional<Eigen::VectorXd> picked(const std::vector<std::string>& joints,
                                             const std::vector<std::string>& names,
                                             const std::vector<double>& values) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(joints.size()));
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), joints[i]);
    const auto index = static_cast<std::size_t>(found - names.begin());
    if (found == names.end() || index >= values.size()) return std::nullopt;
    result[static_cast<Eigen::Index>(i)] = values[index];
  }
  return result;
}

}  // namespace prf_drivers
