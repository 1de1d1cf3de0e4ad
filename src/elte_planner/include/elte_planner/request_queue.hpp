// SPDX-License-Identifier: BSD-3-Clause
//
// Joins progress and forecasts by stamp, whichever arrives first: one request for every new
// forecast that a progress names, in the order of the progress.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "elte_planner/skill_session.hpp"

namespace elte_planner {

struct JoinedRequest {
  Progress progress;
  std::optional<Forecast> forecast;  // nothing when a newer one came and this one never did
  bool new_run = false;              // stamps jumped back before this request
};

class RequestQueue {
 public:
  static constexpr std::int64_t kNewRunJump = 1'000'000'000;  // ns backwards
  static constexpr std::size_t kMaxForecasts = 1000;

  void add(const Progress& progress);
  void add(const Forecast& forecast);

  // The oldest request whose forecast is decided.
  [[nodiscard]] std::optional<JoinedRequest> next();

  std::size_t waiting() const { return requests_.size(); }

 private:
  std::deque<JoinedRequest> requests_;
  std::map<std::int64_t, Forecast> forecasts_;
  std::int64_t newest_progress_ = 0;
  std::int64_t newest_asked_ = 0;
  std::int64_t newest_forecast_ = 0;
  bool new_run_ = false;
};

}  // namespace elte_planner
