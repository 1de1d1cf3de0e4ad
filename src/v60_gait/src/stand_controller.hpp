// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "attitude_reference.hpp"
#include "feet.hpp"
#include "virtual_model.hpp"

namespace v60_gait {

/// Stands and levels itself as the real robot does: soft sideways over its feet, which stay where
/// they are, and at an attitude between level and the deck's.
class StandController : public LegController {
 public:
  StandController(const Stance& stance, const BodyModel& body, double friction);

  [[nodiscard]] LegVector torques(const LegObservation& observed) override;

 private:
  StartHeading heading_;
  Stance stance_;
  VirtualModel model_;
  SlopeEstimate slope_;
  AttitudeReference attitude_;
  double last_time_ = 0.0;
  bool has_time_ = false;
};

}  // namespace v60_gait
