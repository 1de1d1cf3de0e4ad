// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/time.hpp"

#include <gtest/gtest.h>

namespace prf_core {
namespace {

TEST(Time, RoundsSecondsToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(0.01), Duration{10'000'000});
  EXPECT_EQ(from_seconds(1 / 30.0), Duration{33'333'333});
  EXPECT_EQ(from_seconds(-1.6e-9), Duration{-2});
}

TEST(Time, KeepsEveryNanosecondOfADay) {
  for (const std::int64_t ns :
       {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, std::int64_t{86'399'999'999'999}}) {
    EXPECT_EQ(from_seconds(to_seconds(Duration{ns})), Duration{ns});
  }
}

}  // namespace
}  // namespace prf_core
