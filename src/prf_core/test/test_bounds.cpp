// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/bounds.hpp"

#include <gtest/gtest.h>

#include "refusal.hpp"

namespace prf_core {
namespace {

// Fault 1, 43: absurd, infinite or NaN numbers -> refused by name where they become values
TEST(Bounds, HoldNumbersOnBothSidesAndNoNan) {
  for (const double value : {0.0, -kMaxSpeed, kMaxSpeed}) EXPECT_TRUE(is_within(value, kMaxSpeed));
  for (const double value : {1e300, -1e300, 1000.0001, kNan, kInf, -kInf}) {
    EXPECT_FALSE(is_within(value, kMaxSpeed)) << value;
    for (int i = 0; i < 3; ++i) {
      Eigen::Vector3d vector(1.0, 2.0, 3.0);
      EXPECT_TRUE(is_within(vector, kMaxSpeed));
      vector[i] = value;
      EXPECT_FALSE(is_within(vector, kMaxSpeed)) << value;
    }
  }
}

TEST(Bounds, RefuseByNameValueAndBound) {
  EXPECT_EQ(refusal([] { require_within("hand", Eigen::Vector3d(1, 2, 3), 10, "m"); }), "");
  EXPECT_EQ(refusal([] { require_within("hand", Eigen::Vector3d(1, -1e300, 3), 10, "m"); }),
            "hand =       1 -1e+300       3, must be finite and within +-10 m");
  EXPECT_EQ(refusal([] { require_within("P", Eigen::Matrix2d::Constant(20), 10, "m^2"); }),
            "P = 20 at most, must be finite and within +-10 m^2");
}

// Fault 42: stamps at the ends of ROS time -> refused, also an hour before the end
TEST(Bounds, RefuseStampsThatArithmeticCouldOverflow) {
  const Stamp end = std::chrono::seconds(4'294'967'295);
  for (const Stamp stamp : {Stamp{0}, kMaxStamp, Stamp{std::chrono::seconds(1'800'000'000)}}) {
    EXPECT_EQ(refusal([=] { require_stamp("stamp", stamp); }), "");
  }
  for (const Stamp stamp : {Stamp{-1}, kMaxStamp + Duration{1}, end, Stamp::min(), Stamp::max()}) {
    EXPECT_FALSE(is_usable_stamp(stamp)) << stamp.count();
    EXPECT_NE(refusal([=] { require_stamp("stamp", stamp); }).find("stamp = "), std::string::npos);
  }
  EXPECT_EQ(refusal([=] { require_stamp("stamp", end); }),
            "stamp = 4294967295.000000, must be within [0, 4294963695] s");
}

}  // namespace
}  // namespace prf_core
