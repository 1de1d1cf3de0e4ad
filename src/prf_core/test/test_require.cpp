// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/require.hpp"

#include <gtest/gtest.h>

#include "refusal.hpp"

namespace prf_core {
namespace {

TEST(Require, SaysNameValueAndBound) {
  EXPECT_EQ(refusal([] { require(true, "nodes", 1, "> 1"); }), "");
  EXPECT_EQ(refusal([] { require(false, "nodes", 1, "> 1"); }), "nodes = 1, must be > 1");
  EXPECT_EQ(refusal([] { require(false, "planner", "ELTE", "elte or dmp"); }),
            "planner = ELTE, must be elte or dmp");
}

TEST(Require, Finite) {
  EXPECT_EQ(refusal([] { require_finite("gain", -1e300); }), "");
  EXPECT_EQ(refusal([] { require_finite("gain", kNan); }), "gain = nan, must be finite");
  EXPECT_EQ(refusal([] { require_finite("gain", -kInf); }), "gain = -inf, must be finite");
}

TEST(Require, PositiveWithItsUnit) {
  EXPECT_EQ(refusal([] { require_positive("wait", 1e-300, "s"); }), "");
  EXPECT_EQ(refusal([] { require_positive("wait", 0.0, "s"); }), "wait = 0, must be > 0 s");
  EXPECT_EQ(refusal([] { require_positive("scale", -2.5); }), "scale = -2.5, must be > 0");
  EXPECT_EQ(refusal([] { require_positive("scale", kNan); }), "scale = nan, must be > 0");
}

TEST(Require, BetweenWithBothBoundsIncluded) {
  for (const double value : {0.5, 0.7, 2.0}) {
    EXPECT_EQ(refusal([=] { require_between("speed", value, 0.5, 2.0, "m/s"); }), "");
  }
  EXPECT_EQ(refusal([] { require_between("speed", 2.5, 0.5, 2.0, "m/s"); }),
            "speed = 2.5, must be within [0.5, 2] m/s");
  EXPECT_EQ(refusal([] { require_between("share", 0.4, 0.5, 1.0); }),
            "share = 0.4, must be within [0.5, 1]");
  EXPECT_EQ(refusal([] { require_between("share", kNan, 0.5, 1.0); }),
            "share = nan, must be within [0.5, 1]");
  EXPECT_EQ(refusal([] { require_between("limit", kInf, 0.0, kInf); }), "");
}

}  // namespace
}  // namespace prf_core
