// SPDX-License-Identifier: BSD-3-Clause
// Keeps the arm away from the robot's own bodies, from forbidden boxes, and inside its workspace.
//
// What is judged is where the arm comes to rest if it is braked after this tick. With the distance
// d there, the speed is
//   1                                              d >= slow,
//   least + (1 - least) (d - stop) / (slow - stop)  stop <= d < slow,
// and below `stop` the arm is held. Each pair is judged by itself: a motion that leads it apart is
// not slowed down for it, so that the arm can leave where it should not be. Bodies that touch have
// no way out: there the operator has to move the arm.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "prf_drivers/motion_guard.hpp"
#include "prf_drivers/robot_shapes.hpp"

namespace prf_drivers {

inline constexpr double kLeastSpeed = 0.1;

struct ClearanceParams {
  double stop_distance = 0.0;  // m, 0 to 0.5
  double slow_distance = 0.0;  // m, above stop_distance, up to 1

  void validate() const;
};

// The rule above, of what is near now and where the arm comes to rest.
[[nodiscard]] Allowance allowed_by(const ClearanceParams& params, const Clearances& now,
                                   const Clearances& rest);

// The robot's bodies among each other. Pairs that are nearer than stop_distance in the ready
// posture are not looked at; ignored() names them.
class SelfCollisionGuard {
 public:
  SelfCollisionGuard(RobotShapes shapes, const Eigen::VectorXd& ready, ClearanceParams params);
  [[nodiscard]] Allowance allow(const Intended& intended);
  [[nodiscard]] const std::vector<std::string>& ignored() const { return ignored_; }

 private:
  RobotShapes shapes_;
  ClearanceParams params_;
  std::vector<std::string> ignored_;
};

// The arm inside a workspace and outside forbidden boxes.
class BoxGuard {
 public:
  BoxGuard(RobotShapes shapes, std::optional<Box> workspace, std::vector<Box> forbidden,
           ClearanceParams params);
  [[nodiscard]] Allowance allow(const Intended& intended);

 private:
  [[nodiscard]] Clearances clearances(const Eigen::VectorXd& arm, const Measured& measured);

  RobotShapes shapes_;
  std::optional<Box> workspace_;
  std::vector<Box> forbidden_;
  ClearanceParams params_;
};

// Boxes of six numbers each: lower corner, upper corner. Throws std::invalid_argument for another
// count, for what is not finite, and for a corner that is not below the other.
[[nodiscard]] std::vector<Box> boxes_from(const std::string& name,
                                          const std::vector<double>& numbers);

}  // namespace prf_drivers
