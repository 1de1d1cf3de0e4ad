// SPDX-License-Identifier: BSD-3-Clause
//
// Joins progress and forecasts by stamp, whichever arrives first (prf_core/stream_joiner.hpp): one
// request for every new forecast that a progress names, in the order of the progress.
#pragma once

#include <optional>
#include <prf_core/stream_joiner.hpp>

#include "elte_planner/skill_session.hpp"

namespace elte_planner {

struct JoinedRequest {
  Progress progress;
  std::optional<prf_core::TargetForecast> forecast;  // empty: lost, later messages came without it
  bool new_run = false;                              // stamps jumped back before this request
};

class RequestQueue {
 public:
  // Both return what the message's stamp is in its stream. A message that is kOld or kFarAhead was
  // dropped; a progress that is kDuplicate asks only for a forecast not named before.
  prf_core::StampOrder add(const Progress& progress);
  prf_core::StampOrder add(const prf_core::TargetForecast& forecast);

  // The oldest request, once no later message can change whether its forecast comes; else nullopt.
  [[nodiscard]] std::optional<JoinedRequest> next();

  std::size_t waiting() const { return joiner_.waiting(); }

 private:
  prf_core::StreamJoiner<Progress, prf_core::TargetForecast> joiner_{prf_core::JoinParams{}};
  prf_core::Stamp newest_named_{0};  // of the forecasts that a progress of this run named
};

}  // namespace elte_planner
