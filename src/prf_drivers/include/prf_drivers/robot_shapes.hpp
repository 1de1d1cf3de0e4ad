// SPDX-License-Identifier: BSD-3-Clause
// The collision shapes of a robot, from its URDF, where its joints place them. Distances by FCL, in
// metres, of all that are nearer than asked for. Bodies that touch have the distance 0.
//
// Two bodies are looked at together when at least two joints of the arm are between them: what one
// joint separates touches by design, and what none does keeps its place.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace prf_drivers {

// What is near what, and how far apart, m; negative: so far beyond a bound.
using Clearances = std::map<std::string, double>;

// In the frame of the base link, parallel to its axes, m.
struct Box {
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;
};

// rad, of joints of the arm in the order asked for; infinite where a joint has no bound.
struct JointRange {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

// Throws as RobotShapes.
[[nodiscard]] JointRange joint_range(const std::string& urdf, const std::vector<std::string>& arm);

class RobotShapes {
 public:
  // `arm` are the joints that move, others stand where place() has them, or at 0. Throws
  // std::invalid_argument for text that is no URDF, a link or joint that is not in it, a mesh, and
  // an arm that carries no shape.
  RobotShapes(const std::string& urdf, const std::string& base_link,
              const std::vector<std::string>& arm);
  ~RobotShapes();
  RobotShapes(RobotShapes&&) noexcept;
  RobotShapes& operator=(RobotShapes&&) noexcept;

  // `arm` in rad; one value for each joint, else std::invalid_argument.
  void place(const Eigen::VectorXd& arm, const std::map<std::string, double>& elsewhere);

  // Bodies among each other, by their links.
  [[nodiscard]] Clearances between_bodies(double within) const;
  // The arm and a box that it must not enter, called `name`.
  [[nodiscard]] Clearances outside(const Box& box, const std::string& name, double within) const;
  // The arm and the walls of a box that it must not leave.
  [[nodiscard]] Clearances inside(const Box& box, double within) const;

  // Pairs that are nearer than this as placed are not looked at any more. Returns their names.
  std::vector<std::string> ignore_nearer_than(double distance);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prf_drivers
