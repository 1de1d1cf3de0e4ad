// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/orientation_blend.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace elte_planner {

std::vector<Eigen::Quaterniond> blend_orientations(
    const std::vector<Eigen::Quaterniond>& demonstrated,
    const std::vector<Eigen::Quaterniond>& previous, Eigen::Index frozen,
    const std::vector<Eigen::Quaterniond>& goals) {
  const std::size_t nodes = demonstrated.size();
  if (previous.size() != nodes) {
    throw std::invalid_argument("previous plan has " + std::to_string(previous.size()) +
                                " orientations, must have " + std::to_string(nodes));
  }
  if (frozen < 1 || frozen > static_cast<Eigen::Index>(nodes)) {
    throw std::invalid_argument("frozen is " + std::to_string(frozen) + ", must be within [1, " +
                                std::to_string(nodes) + "]");
  }
  if (goals.empty() || goals.size() > nodes) {
    throw std::invalid_argument("goals has " + std::to_string(goals.size()) +
                                " orientations, must have 1 to " + std::to_string(nodes));
  }
  std::vector<Eigen::Quaterniond> result = previous;
  const auto first = static_cast<std::size_t>(frozen);
  const Eigen::Quaterniond here = previous[first - 1] * demonstrated[first - 1].conjugate();
  const std::size_t first_goal = nodes - goals.size();
  const auto correction = [&](std::size_t k) -> Eigen::Quaterniond {
    return goals[k - first_goal] * demonstrated[k].conjugate();
  };
  for (std::size_t k = first; k < nodes; ++k) {
    Eigen::Quaterniond turn = correction(std::max(k, first_goal));
    if (k < first_goal) {
      turn = here.slerp(
          static_cast<double>(k - first + 1) / static_cast<double>(first_goal - first + 1), turn);
    }
    result[k] = (turn * demonstrated[k]).normalized();
    if (result[k].dot(result[k - 1]) < 0.0) result[k].coeffs() = -result[k].coeffs();
  }
  return result;
}

}  // namespace elte_planner
