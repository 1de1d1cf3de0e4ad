// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/request_queue.hpp"

namespace elte_planner {

using prf_core::StampOrder;

StampOrder RequestQueue::add(const Progress& progress) {
  const StampOrder order = joiner_.advance(progress.stamp);
  if (!prf_core::is_accepted(order) && order != StampOrder::kDuplicate) return order;
  if (order == StampOrder::kBackwardJump) newest_named_ = prf_core::Stamp{0};
  if (progress.forecast_stamp <= newest_named_) return order;
  newest_named_ = progress.forecast_stamp;
  joiner_.push_primary(progress.stamp, progress.forecast_stamp, progress);
  return order;
}

StampOrder RequestQueue::add(const prf_core::TargetForecast& forecast) {
  return joiner_.push_secondary(forecast.stamp, forecast);
}

std::optional<JoinedRequest> RequestQueue::next() {
  auto joined = joiner_.pop();
  if (!joined) return std::nullopt;
  return JoinedRequest{joined->primary, joined->secondary, joined->new_run};
}

}  // namespace elte_planner
