// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/request_queue.hpp"

#include <algorithm>

namespace elte_planner {

void RequestQueue::add(const Progress& progress) {
  if (progress.stamp < newest_progress_ - kNewRunJump) {
    requests_.clear();
    forecasts_.erase(forecasts_.upper_bound(progress.stamp + kNewRunJump), forecasts_.end());
    newest_forecast_ = forecasts_.empty() ? 0 : forecasts_.rbegin()->first;
    newest_progress_ = newest_asked_ = 0;
    new_run_ = true;
  }
  newest_progress_ = std::max(newest_progress_, progress.stamp);
  if (progress.forecast_stamp <= newest_asked_) return;
  newest_asked_ = progress.forecast_stamp;
  requests_.push_back({progress, std::nullopt, new_run_});
  new_run_ = false;
}

void RequestQueue::add(const Forecast& forecast) {
  if (forecast.stamp < newest_forecast_ - kNewRunJump) {
    forecasts_.clear();
    newest_forecast_ = 0;
  }
  newest_forecast_ = std::max(newest_forecast_, forecast.stamp);
  forecasts_.emplace(forecast.stamp, forecast);
  if (forecasts_.size() > kMaxForecasts) forecasts_.erase(forecasts_.begin());
}

std::optional<JoinedRequest> RequestQueue::next() {
  if (requests_.empty()) return std::nullopt;
  const std::int64_t wanted = requests_.front().progress.forecast_stamp;
  if (newest_forecast_ < wanted) return std::nullopt;
  JoinedRequest request = requests_.front();
  requests_.pop_front();
  const auto found = forecasts_.find(wanted);
  if (found != forecasts_.end()) request.forecast = found->second;
  forecasts_.erase(forecasts_.begin(), forecasts_.upper_bound(wanted));
  return request;
}

}  // namespace elte_planner
