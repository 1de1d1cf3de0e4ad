// SPDX-License-Identifier: BSD-3-Clause
// The types of prf_core that the decision works with. Poses are in the planning frame (base of the
// arm).
#pragma once

#include <prf_core/forecast.hpp>
#include <prf_core/se3.hpp>
#include <prf_core/time.hpp>
#include <prf_core/trajectory.hpp>

namespace prf_decision {

using prf_core::Duration;
using prf_core::from_seconds;
using prf_core::MovingPose;
using prf_core::Pose;
using prf_core::Stamp;
using prf_core::TargetForecast;
using prf_core::TargetStatus;
using prf_core::to_seconds;
using prf_core::Trajectory;

}  // namespace prf_decision
