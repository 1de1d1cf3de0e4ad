// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/stream.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace prf_core {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

template <typename Message>
std::string stamps_of(const StampedQueue<Message>& queue) {
  std::string text;
  for (const auto& item : queue.items()) text += std::to_string(item.stamp.count()) + " ";
  return text;
}

StampedQueue<int> queue_of(std::initializer_list<int> stamps, std::size_t capacity = 1000) {
  StampedQueue<int> queue({Duration{100}, Duration{1000}, 3}, capacity);
  for (const int stamp : stamps) queue.push(Stamp{stamp}, stamp);
  return queue;
}

// Fault 8, 9, 10: a stamp that is old, double or far ahead -> not stored, the order tells which
TEST(StampedQueue, StoresRisingStampsOnly) {
  StampedQueue<int> queue = queue_of({500, 600});
  EXPECT_EQ(queue.push(Stamp{600}, 1), StampOrder::kDuplicate);
  EXPECT_EQ(queue.push(Stamp{550}, 1), StampOrder::kOld);
  EXPECT_EQ(queue.push(Stamp{1601}, 1), StampOrder::kFarAhead);
  EXPECT_EQ(stamps_of(queue), "500 600 ");
  EXPECT_EQ(queue.push(Stamp{601}, 1), StampOrder::kNewer);
  EXPECT_EQ(stamps_of(queue), "500 600 601 ");
}

// Fault 11: the clock jumps back -> at the third stamp what is queued of the old run is dropped
TEST(StampedQueue, DropsTheOldRunWhenTheClockGoesBack) {
  StampedQueue<int> queue = queue_of({500, 600});
  for (const int stamp : {10, 20}) EXPECT_EQ(queue.push(Stamp{stamp}, 1), StampOrder::kOld);
  EXPECT_EQ(stamps_of(queue), "500 600 ");
  EXPECT_EQ(queue.push(Stamp{30}, 1), StampOrder::kBackwardJump);
  EXPECT_EQ(stamps_of(queue), "30 ");
}

// Fault 13: the clock leaps forward -> stored again from the third stamp on
TEST(StampedQueue, StoresFromTheStampThatProvesThatTheClockLeapt) {
  StampedQueue<int> queue = queue_of({500, 9000, 9010});
  EXPECT_EQ(queue.push(Stamp{9020}, 1), StampOrder::kForwardJump);
  EXPECT_EQ(stamps_of(queue), "500 9020 ");
}

TEST(StampedQueue, DropsTheOldestBeyondItsCapacity) {
  EXPECT_EQ(stamps_of(queue_of({1, 2, 3, 4, 5}, 3)), "3 4 5 ");
}

TEST(StampedQueue, FindsExactStamps) {
  const StampedQueue<int> queue = queue_of({10, 20, 30});
  ASSERT_NE(queue.find(Stamp{20}), nullptr);
  EXPECT_EQ(*queue.find(Stamp{20}), 20);
  for (const int stamp : {0, 19, 21, 31}) EXPECT_EQ(queue.find(Stamp{stamp}), nullptr) << stamp;
}

TEST(StampedQueue, DropsBeforeAndAfterAStamp) {
  StampedQueue<int> queue = queue_of({10, 20, 30, 40});
  queue.drop_before(Stamp{20});
  queue.drop_after(Stamp{30});
  EXPECT_EQ(stamps_of(queue), "20 30 ");
  queue.drop_before(Stamp{100});
  EXPECT_EQ(stamps_of(queue), "");
}

TEST(StampedQueue, GivesOutTheOldestUntilAStamp) {
  StampedQueue<std::unique_ptr<int>> queue;
  for (const int stamp : {10, 20}) queue.push(Stamp{stamp}, std::make_unique<int>(stamp));
  EXPECT_FALSE(queue.pop_until(Stamp{9}));
  EXPECT_EQ(*queue.pop_until(Stamp{10})->message, 10);
  EXPECT_FALSE(queue.pop_until(Stamp{19}));
  EXPECT_EQ(*queue.pop_until(Stamp{99})->message, 20);
  EXPECT_FALSE(queue.pop_until(Stamp{99}));
}

TEST(StampedQueue, RemembersItsClockWhenEmptied) {
  StampedQueue<int> queue = queue_of({500});
  queue.clear();
  EXPECT_EQ(queue.push(Stamp{450}, 1), StampOrder::kOld);
  queue.clock().restart();
  EXPECT_EQ(queue.push(Stamp{450}, 1), StampOrder::kNewer);
}

// Fault 12: the data's clock pauses -> no time-out trips; silence is counted in data time alone
TEST(SilenceMonitor, GivesUpByDataTimeUntilTheStreamIsHeardAgain) {
  SilenceMonitor silence(milliseconds(300));
  EXPECT_FALSE(silence.gives_up(seconds(1), seconds(1)));
  EXPECT_FALSE(silence.gives_up(seconds(1), milliseconds(1300)));
  EXPECT_TRUE(silence.gives_up(seconds(1), milliseconds(1300) + Duration{1}));
  EXPECT_TRUE(silence.is_silent());
  EXPECT_TRUE(silence.gives_up(seconds(2), seconds(2)));
  silence.heard();
  EXPECT_FALSE(silence.is_silent());
  EXPECT_FALSE(silence.gives_up(seconds(2), seconds(2)));
}

TEST(SilenceMonitor, CanWaitWithoutEnd) {
  SilenceMonitor silence(Duration::max());
  EXPECT_FALSE(silence.gives_up(Stamp{0}, seconds(9'000'000'000)));
}

TEST(SilenceMonitor, RefusesAnImpossibleWait) {
  for (const Duration wait : {Duration{0}, Duration{-1}}) {
    EXPECT_THROW(SilenceMonitor{wait}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace prf_core
