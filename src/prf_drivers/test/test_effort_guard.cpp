// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/effort_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace prf_drivers {
namespace {

using std::chrono::milliseconds;

EffortParams params() { return {Eigen::Vector2d(-4.0, -2.0), Eigen::Vector2d(5.0, 2.0), 0.05}; }

Allowance ask(EffortGuard& guard, prf_core::Stamp stamp, const Eigen::VectorXd& effort) {
  Measured measured(Eigen::Vector2d::Zero());
  measured.effort = effort;
  return guard.allow({stamp, measured, Eigen::Vector2d::Zero()});
}

// Fault 56: the arm pushes against something -> protective stop, until it is reset
TEST(EffortGuard, StopsWhenAnEffortStaysBeyondItsBounds) {
  EffortGuard guard(params(), {"left", "right"});
  EXPECT_FALSE(ask(guard, milliseconds(0), Eigen::Vector2d(4.9, -1.9)).hold);
  EXPECT_FALSE(ask(guard, milliseconds(10), Eigen::Vector2d(4.9, -2.1)).hold);
  const Allowance stop = ask(guard, milliseconds(60), Eigen::Vector2d(4.9, -2.1));
  EXPECT_TRUE(stop.hold);
  EXPECT_EQ(stop.code, MotionCode::kProtectiveStop);
  EXPECT_NE(stop.why.find("right is -2.1 N m"), std::string::npos) << stop.why;
  EXPECT_TRUE(ask(guard, milliseconds(70), Eigen::Vector2d(0.0, 0.0)).hold);
  guard.reset();
  EXPECT_FALSE(ask(guard, milliseconds(80), Eigen::Vector2d(0.0, 0.0)).hold);
}

TEST(EffortGuard, ForgivesWhatIsShort) {
  EffortGuard guard(params(), {"left", "right"});
  for (int i = 0; i < 20; ++i) {
    const double effort = i % 4 == 3 ? 0.0 : 9.0;
    EXPECT_FALSE(ask(guard, milliseconds(10 * i), Eigen::Vector2d(effort, 0.0)).hold);
  }
}

// Fault 1: efforts that are not a number, or not told -> protective stop, where bounds are set
TEST(EffortGuard, StopsWhenEffortsAreNotKnown) {
  for (const Eigen::VectorXd& bad :
       {Eigen::VectorXd(Eigen::Vector2d(std::nan(""), 0.0)), Eigen::VectorXd()}) {
    EffortGuard guard(params(), {"left", "right"});
    (void)ask(guard, milliseconds(0), bad);
    EXPECT_TRUE(ask(guard, milliseconds(50), bad).hold);
  }
}

TEST(EffortGuard, LooksAtNothingWithoutBounds) {
  EffortGuard guard({{}, {}, 0.05}, {"left", "right"});
  EXPECT_FALSE(ask(guard, milliseconds(0), Eigen::Vector2d(std::nan(""), 1e9)).hold);
}

TEST(EffortGuard, RefusesBoundsThatAreNone) {
  const auto refused = [](const std::function<void(EffortParams&)>& spoil) {
    EffortParams spoilt = params();
    spoil(spoilt);
    EXPECT_THROW(EffortGuard(spoilt, {"left", "right"}), std::invalid_argument);
  };
  refused([](EffortParams& p) { p.lower = Eigen::Vector3d::Zero(); });
  refused([](EffortParams& p) { p.lower.resize(0); });
  refused([](EffortParams& p) { p.lower[0] = 5.0; });
  refused([](EffortParams& p) { p.upper[1] = std::nan(""); });
  refused([](EffortParams& p) { p.patience = 2.0; });
}

}  // namespace
}  // namespace prf_drivers
