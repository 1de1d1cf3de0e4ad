// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/request_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace elte_planner {
namespace {

using std::chrono::milliseconds;

Progress progress(std::int64_t stamp_ms, std::int64_t forecast_ms) {
  return {milliseconds(stamp_ms), milliseconds(forecast_ms), 2, std::chrono::seconds(1)};
}

prf_core::TargetForecast forecast(std::int64_t stamp_ms) {
  prf_core::TargetForecast result;
  result.stamp = milliseconds(stamp_ms);
  return result;
}

std::vector<JoinedRequest> drained(RequestQueue& queue) {
  std::vector<JoinedRequest> result;
  while (auto request = queue.next()) result.push_back(*request);
  return result;
}

TEST(RequestQueue, AsksOnceForEveryForecastNamed) {
  RequestQueue queue;
  queue.add(forecast(100));
  queue.add(progress(160, 0));
  queue.add(progress(170, 100));
  queue.add(progress(180, 100));
  const auto requests = drained(queue);
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].progress.stamp, milliseconds(170));
  ASSERT_TRUE(requests[0].forecast);
  EXPECT_EQ(requests[0].forecast->stamp, milliseconds(100));
}

TEST(RequestQueue, GivesTheSameRequestsInAnyOrderBetweenTheTopics) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 500; ++trial) {
    RequestQueue queue;
    std::vector<JoinedRequest> requests;
    std::int64_t next_forecast = 100;
    std::int64_t next_progress = 170;
    while (next_forecast <= 2000 || next_progress <= 2070) {
      const bool forecast_first = std::bernoulli_distribution(0.5)(random);
      if ((forecast_first && next_forecast <= 2000) || next_progress > 2070) {
        queue.add(forecast(next_forecast));
        next_forecast += 100;
      } else {
        queue.add(progress(next_progress, (next_progress - 70) / 100 * 100));
        next_progress += 10;
      }
      for (const auto& request : drained(queue)) requests.push_back(request);
    }
    ASSERT_EQ(requests.size(), 20u);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const std::int64_t stamp = 100 * static_cast<std::int64_t>(i + 1);
      ASSERT_EQ(requests[i].progress.forecast_stamp, milliseconds(stamp));
      ASSERT_EQ(requests[i].progress.stamp, milliseconds(stamp + 70));
      ASSERT_TRUE(requests[i].forecast);
      ASSERT_EQ(requests[i].forecast->stamp, milliseconds(stamp));
    }
  }
}

TEST(RequestQueue, WaitsForAForecastOnlyUntilANewerOneCame) {
  RequestQueue queue;
  queue.add(forecast(100));
  queue.add(progress(260, 200));
  EXPECT_TRUE(drained(queue).empty());
  EXPECT_EQ(queue.waiting(), 1u);
  queue.add(forecast(300));
  const auto requests = drained(queue);
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_FALSE(requests[0].forecast);
}

TEST(RequestQueue, StartsANewRunWhenStampsGoBack) {
  for (const bool forecast_first : {true, false}) {
    RequestQueue queue;
    queue.add(forecast(50'000));
    queue.add(progress(50'060, 50'000));
    EXPECT_EQ(drained(queue).size(), 1u);
    queue.add(forecast(50'033));
    for (const std::int64_t stamp : {140, 150}) queue.add(progress(stamp, 100));
    EXPECT_TRUE(drained(queue).empty());
    if (forecast_first) {
      queue.add(forecast(100));
      queue.add(progress(160, 100));
    } else {
      queue.add(progress(160, 100));
      EXPECT_TRUE(drained(queue).empty());
      queue.add(forecast(100));
    }
    const auto requests = drained(queue);
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_TRUE(requests[0].new_run);
    EXPECT_TRUE(requests[0].forecast);
  }
}

TEST(RequestQueue, IgnoresForecastsNamedAgainLater) {
  RequestQueue queue;
  for (const std::int64_t stamp : {100, 133, 166}) queue.add(forecast(stamp));
  queue.add(progress(200, 133));
  queue.add(progress(210, 100));
  queue.add(progress(220, 166));
  const auto requests = drained(queue);
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_EQ(requests[1].progress.stamp, milliseconds(220));
  EXPECT_FALSE(requests[1].new_run);
}

// Fault 40: one progress or forecast late, early or doubled -> dropped and told; every plan
// still comes
TEST(RequestQueue, LosesNothingToOneMessageOutOfPlace) {
  using prf_core::StampOrder;
  constexpr std::int64_t kWrong[] = {0, 100, 9'995, 14'000, 4'294'967'295'000};
  for (const std::int64_t wrong : kWrong) {
    for (const bool wrong_forecast : {true, false}) {
      RequestQueue queue;
      std::size_t requests = 0;
      for (std::int64_t i = 0; i < 30; ++i) {
        const std::int64_t stamp = 10'000 + 33 * i;
        if (i == 15) {
          const StampOrder order =
              wrong_forecast ? queue.add(forecast(wrong)) : queue.add(progress(wrong, wrong - 10));
          EXPECT_EQ(order, wrong < 10'000 ? StampOrder::kOld : StampOrder::kFarAhead) << wrong;
        }
        EXPECT_EQ(queue.add(forecast(stamp)), StampOrder::kNewer);
        EXPECT_EQ(queue.add(progress(stamp + 20, stamp)), StampOrder::kNewer);
        EXPECT_EQ(queue.add(progress(stamp + 20, stamp)), StampOrder::kDuplicate);
        for (const auto& request : drained(queue)) {
          EXPECT_FALSE(request.new_run);
          EXPECT_TRUE(request.forecast);
          ++requests;
        }
      }
      EXPECT_EQ(requests, 30u) << wrong << wrong_forecast;
    }
  }
}

TEST(RequestQueue, HoldsABoundedNumberOfForecasts) {
  RequestQueue queue;
  for (std::int64_t stamp = 1; stamp <= 5000; ++stamp) queue.add(forecast(stamp));
  queue.add(progress(5000, 100));
  queue.add(progress(5010, 4500));
  const auto requests = drained(queue);
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_FALSE(requests[0].forecast);
  EXPECT_TRUE(requests[1].forecast);
}

}  // namespace
}  // namespace elte_planner
