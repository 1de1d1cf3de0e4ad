// SPDX-License-Identifier: BSD-3-Clause
// All guards of an arm. The first that holds counts, else the slowest.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "prf_drivers/clearance_guard.hpp"
#include "prf_drivers/effort_guard.hpp"
#include "prf_drivers/joint_range_guard.hpp"
#include "prf_drivers/start_guard.hpp"

namespace prf_drivers {

struct GuardsParams {
  std::vector<std::string> joints;
  StartParams start;
  EffortParams effort;
  std::string base_link;          // of the boxes
  std::vector<double> workspace;  // m, lower corner, upper corner; empty: none
  std::vector<double> forbidden;  // m, six a box
  bool self_collision = false;
  bool joint_bounds = false;  // of the URDF
  ClearanceParams clearance;
  std::string urdf;  // read where boxes, self_collision or joint_bounds need it

  [[nodiscard]] bool needs_urdf() const;
};

class MotionGuards : public MotionGuard {
 public:
  // Throws std::invalid_argument with name, value and bound.
  explicit MotionGuards(const GuardsParams& params);

  [[nodiscard]] Allowance allow(const Intended& intended) override;
  void reset() override;
  void goes_forward(prf_core::Stamp stamp) { start_.goes_forward(stamp); }

  // Pairs of bodies that the ready posture lets touch; for the log.
  [[nodiscard]] std::vector<std::string> ignored() const;

 private:
  StartGuard start_;
  EffortGuard effort_;
  std::optional<JointRangeGuard> range_;
  std::optional<SelfCollisionGuard> self_;
  std::optional<BoxGuard> boxes_;
};

}  // namespace prf_drivers
