// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/orientation_blend.hpp"

#include <stdexcept>
#include <string>

namespace elte_planner {

std::vector<Eigen::Quaterniond> blend_orientations(
    const std::vector<Eigen::Quaterniond>& demonstrated,
    const std::vector<Eigen::Quaterniond>& previous, Eigen::Index frozen,
    const Eigen::Quaterniond& goal) {
  const std::size_t nodes = demonstrated.size();
  if (previous.size() != nodes) {
    throw std::invalid_argument("previous plan has " + std::to_string(previous.size()) +
                                " orientations, must have " + std::to_string(nodes));
  }
  if (frozen < 1 || frozen > static_cast<Eigen::Index>(nodes)) {
    throw std::invalid_argument("frozen is " + std::to_string(frozen) + ", must be within [1, " +
                                std::to_string(nodes) + "]");
  }
  std::vector<Eigen::Quaterniond> result = previous;
  const auto first = static_cast<std::size_t>(frozen);
  const Eigen::Quaterniond here = previous[first - 1] * demonstrated[first - 1].conjugate();
  const Eigen::Quaterniond there = goal * demonstrated.back().conjugate();
  for (std::size_t k = first; k < nodes; ++k) {
    const double fraction = static_cast<double>(k - first + 1) / static_cast<double>(nodes - first);
    result[k] = (here.slerp(fraction, there) * demonstrated[k]).normalized();
    if (result[k].dot(result[k - 1]) < 0.0) result[k].coeffs() = -result[k].coeffs();
  }
  return result;
}

}  // namespace elte_planner
