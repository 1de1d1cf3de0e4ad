// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace platform_sim {

/// Contact of a pair of links during one control period. Names are URDF links, except `body`
/// (base_link and all that is fixed to it), `box` (its five walls), `post` or `cart`,
/// `obstacle` (the post before the box), and `platform` (the floor too).
struct Contact {
  std::string link_a;  ///< link_a < link_b in alphabetical order
  std::string link_b;
  double force = 0.0;  ///< N; normal forces summed over the pair's points, largest 1 ms step
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< strongest point of that step, world, m
};

/// One contact point of one physics step.
struct ContactPoint {
  std::string link_a;
  std::string link_b;
  double force = 0.0;  ///< normal impulse / step, N
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

/// Gathers the points of successive physics steps into one Contact per pair.
class ContactRecorder {
 public:
  /// Adds all points of one physics step.
  void add_step(const std::vector<ContactPoint>& points);
  /// Contacts since the last call, in alphabetical order of pairs; forgets them.
  [[nodiscard]] std::vector<Contact> take();

 private:
  using Pair = std::pair<std::string, std::string>;
  std::map<Pair, Contact> contacts_;
};

}  // namespace platform_sim
