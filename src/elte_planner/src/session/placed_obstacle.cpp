// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/placed_obstacle.hpp"

#include <cmath>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <sstream>

namespace elte_planner {
namespace {

constexpr const char* kForm =
    "'sphere [on_target] X Y Z RADIUS' or 'box [on_target] X Y Z HALF_X HALF_Y HALF_Z'";
constexpr const char* kViaForm = "'SHARE [on_target] X Y Z RADIUS'";
constexpr double kFarthest = 10.0;  // m, as far as a demonstration may reach

// Whether the next word is on_target, which is then taken.
bool takes_on_target(std::istringstream& words) {
  const auto before = words.tellg();
  std::string word;
  if (words >> word && word == "on_target") return true;
  words.clear();
  words.seekg(before);
  return false;
}

std::vector<double> numbers_of(std::istringstream& words) {
  std::vector<double> numbers;
  for (double number; words >> number;) numbers.push_back(number);
  return numbers;
}

// A place, then sizes.
void require_near(const char* name, const std::string& entry, const std::vector<double>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    prf_core::require_between(std::string(name) + ": number in " + prf_core::quoted(entry),
                              numbers[i], i < 3 ? -kFarthest : 0.0, kFarthest, "m");
  }
}

std::vector<std::string> entries_of(const std::string& text) {
  std::vector<std::string> entries;
  std::istringstream stream(text);
  for (std::string entry; std::getline(stream, entry, ';');) {
    if (entry.find_first_not_of(" \t\n") != std::string::npos) entries.push_back(entry);
  }
  return entries;
}

PlacedVia via_from(const std::string& entry) {
  std::istringstream words(entry);
  PlacedVia result;
  words >> result.share;
  prf_core::require(static_cast<bool>(words) && result.share > 0.0 && result.share < 1.0,
                    "via_points: share of the path in", prf_core::quoted(entry),
                    std::string("within (0, 1): ") + kViaForm);
  result.on_target = takes_on_target(words);
  const std::vector<double> numbers = numbers_of(words);
  prf_core::require(words.eof() && numbers.size() == 4, "via_points", prf_core::quoted(entry),
                    kViaForm);
  require_near("via_points", entry, numbers);
  result.centre = {numbers[0], numbers[1], numbers[2]};
  result.radius = numbers[3];
  return result;
}

PlacedObstacle obstacle_from(const std::string& entry) {
  std::istringstream words(entry);
  std::string shape;
  words >> shape;
  PlacedObstacle result;
  result.on_target = takes_on_target(words);
  const std::vector<double> numbers = numbers_of(words);
  const bool is_sphere = shape == "sphere" && numbers.size() == 4;
  const bool is_box = shape == "box" && numbers.size() == 6;
  prf_core::require(words.eof() && (is_sphere || is_box), "obstacles", prf_core::quoted(entry),
                    kForm);
  require_near("obstacles", entry, numbers);
  const Eigen::Vector3d centre(numbers[0], numbers[1], numbers[2]);
  result.shape = is_sphere
                     ? Obstacle::disc(centre, numbers[3])
                     : Obstacle::box(centre, Eigen::Vector3d(numbers[3], numbers[4], numbers[5]));
  return result;
}

}  // namespace

Obstacle PlacedObstacle::in_planning_frame(const prf_core::Pose& target) const {
  Obstacle result = shape;
  if (!on_target) return result;
  result.centre = target.isometry() * Eigen::Vector3d(shape.centre);
  if (shape.shape == Obstacle::Shape::kDisc) return result;
  const Eigen::Matrix3d turn = target.orientation.toRotationMatrix();
  result.axes = shape.axes.size() == 0 ? turn : Eigen::Matrix3d(turn * shape.axes);
  return result;
}

std::vector<PlacedObstacle> obstacles_from(const std::string& text) {
  std::vector<PlacedObstacle> result;
  for (const std::string& entry : entries_of(text)) result.push_back(obstacle_from(entry));
  prf_core::require(result.size() <= kMostObstacles, "obstacles", result.size(),
                    "at most " + std::to_string(kMostObstacles));
  return result;
}

Eigen::Index PlacedVia::node(int nodes) const {
  return static_cast<Eigen::Index>(std::lround(share * static_cast<double>(nodes - 1)));
}

Eigen::Vector3d PlacedVia::in_planning_frame(const prf_core::Pose& target) const {
  return on_target ? Eigen::Vector3d(target.isometry() * centre) : centre;
}

std::vector<PlacedVia> via_points_from(const std::string& text) {
  std::vector<PlacedVia> result;
  for (const std::string& entry : entries_of(text)) result.push_back(via_from(entry));
  prf_core::require(result.size() <= kMostObstacles, "via_points", result.size(),
                    "at most " + std::to_string(kMostObstacles));
  return result;
}

}  // namespace elte_planner
