// SPDX-License-Identifier: BSD-3-Clause
// What a guard is asked at every tick, and what it says.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <prf_core/time.hpp>
#include <string>

namespace prf_drivers {

// Codes of ~status. Up to 5 they are those of moveit_servo; 1 and 2, near a singularity, do not
// occur: the controller passes singularities.
enum class MotionCode : std::int8_t {
  kNoCommand = -1,  // so far
  kFollows = 0,
  kSlowsForCollision = 3,
  kHaltsForCollision = 4,
  kJointBound = 5,
  kHeld = 10,           // by the operator, the bring-up check, the start, or for want of commands
  kProtectiveStop = 11  // until ~reset
};

// Measured at a tick. Joints in the driver's order, rad and N m.
struct Measured {
  Measured() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): positions alone are what most callers have.
  Measured(Eigen::VectorXd positions) : position(std::move(positions)) {}

  Eigen::VectorXd position;                 // not-a-number: not known
  Eigen::VectorXd effort;                   // empty: not told
  std::map<std::string, double> elsewhere;  // joints of the robot that are not the arm's
};

struct Intended {
  prf_core::Stamp stamp{0};
  const Measured& measured;
  Eigen::VectorXd rest;  // where the arm comes to rest when it is braked after this tick, rad
};

struct Allowance {
  double speed = 1.0;  // share of the velocity limits, 0 to 1
  std::string why;     // it is less, or the arm is held
  bool hold = false;
  MotionCode code = MotionCode::kFollows;
};

class MotionGuard {
 public:
  virtual ~MotionGuard() = default;
  [[nodiscard]] virtual Allowance allow(const Intended& intended) = 0;
  // Another run, or the operator's reset: what was latched or had begun is forgotten.
  virtual void reset() = 0;
};

}  // namespace prf_drivers
