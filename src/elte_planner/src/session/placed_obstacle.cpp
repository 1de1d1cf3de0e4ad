// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/placed_obstacle.hpp"

#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <sstream>

namespace elte_planner {
namespace {

constexpr const char* kForm =
    "'sphere [on_target] X Y Z RADIUS' or 'box X Y Z HALF_X HALF_Y HALF_Z'";
constexpr double kFarthest = 10.0;    // m, as far as a demonstration may reach
constexpr std::size_t kMaxCount = 8;  // each makes a plan dearer

PlacedObstacle obstacle_from(const std::string& entry) {
  std::istringstream words(entry);
  std::string shape;
  words >> shape;
  PlacedObstacle result;
  words >> std::ws;
  if (shape == "sphere" && words.peek() == 'o') {
    std::string place;
    words >> place;
    prf_core::require(place == "on_target", "obstacles", prf_core::quoted(entry), kForm);
    result.on_target = true;
  }
  std::vector<double> numbers;
  for (double number; words >> number;) numbers.push_back(number);
  const bool is_sphere = shape == "sphere" && numbers.size() == 4;
  const bool is_box = shape == "box" && numbers.size() == 6;
  prf_core::require(words.eof() && (is_sphere || is_box), "obstacles", prf_core::quoted(entry),
                    kForm);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    prf_core::require_between("obstacles: number in " + prf_core::quoted(entry), numbers[i],
                              i < 3 ? -kFarthest : 0.0, kFarthest, "m");
  }
  const Eigen::Vector3d centre(numbers[0], numbers[1], numbers[2]);
  result.shape = is_sphere
                     ? Obstacle::disc(centre, numbers[3])
                     : Obstacle::box(centre, Eigen::Vector3d(numbers[3], numbers[4], numbers[5]));
  return result;
}

}  // namespace

Obstacle PlacedObstacle::in_planning_frame(const prf_core::Pose& target) const {
  Obstacle result = shape;
  if (on_target) result.centre = target.isometry() * Eigen::Vector3d(shape.centre);
  return result;
}

std::vector<PlacedObstacle> obstacles_from(const std::string& text) {
  std::vector<PlacedObstacle> result;
  std::istringstream entries(text);
  for (std::string entry; std::getline(entries, entry, ';');) {
    if (entry.find_first_not_of(" \t\n") == std::string::npos) continue;
    result.push_back(obstacle_from(entry));
  }
  prf_core::require(result.size() <= kMaxCount, "obstacles", result.size(),
                    "at most " + std::to_string(kMaxCount));
  return result;
}

}  // namespace elte_planner
