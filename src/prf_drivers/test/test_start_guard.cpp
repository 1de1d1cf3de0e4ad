// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/start_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace prf_drivers {
namespace {

using prf_core::Stamp;

constexpr std::chrono::milliseconds kKnown(50);

StartParams params() { return {Eigen::Vector2d(1.0, -1.0), 0.3, 0.4, kKnown}; }

Allowance ask(StartGuard& guard, Stamp stamp, double a, double b) {
  return guard.allow({stamp, Measured(Eigen::Vector2d(a, b)), Eigen::Vector2d(a, b)});
}

// Fault 47: motion begins with the arm far from its ready posture -> it is held, the joint named
TEST(StartGuard, BeginsNearTheReadyPostureOnly) {
  StartGuard guard(params(), {"left", "right"});
  const Allowance far = ask(guard, Stamp(0), 1.1, -0.5);
  EXPECT_TRUE(far.hold);
  EXPECT_NE(far.why.find("right is 0.50 rad"), std::string::npos) << far.why;
  EXPECT_TRUE(ask(guard, Stamp(0), std::nan(""), -1.0).hold);
  EXPECT_FALSE(ask(guard, Stamp(0), 1.1 + 2.0 * M_PI, -0.9).hold);
  EXPECT_FALSE(ask(guard, Stamp(0), 3.0, 3.0).hold);  // it has begun
}

TEST(StartGuard, IsSlowUntilTheExecutionGoesForward) {
  StartGuard guard(params(), {"left", "right"});
  EXPECT_EQ(ask(guard, Stamp(0), 1.0, -1.0).speed, 0.4);
  guard.goes_forward(std::chrono::milliseconds(100));
  guard.goes_forward(std::chrono::milliseconds(200));
  EXPECT_EQ(ask(guard, std::chrono::milliseconds(149), 1.0, -1.0).speed, 0.4);
  EXPECT_EQ(ask(guard, std::chrono::milliseconds(150), 1.0, -1.0).speed, 1.0);
  guard.reset();
  EXPECT_EQ(ask(guard, std::chrono::milliseconds(160), 1.0, -1.0).speed, 0.4);
  EXPECT_TRUE((guard.reset(), ask(guard, std::chrono::milliseconds(170), 3.0, 3.0).hold));
}

TEST(StartGuard, BeginsAnywhereWithoutAReadyPosture) {
  StartParams anywhere = params();
  anywhere.ready.resize(0);
  StartGuard guard(anywhere, {"left", "right"});
  EXPECT_FALSE(ask(guard, Stamp(0), 3.0, 3.0).hold);
}

TEST(StartGuard, RefusesParametersBeyondTheirBounds) {
  const auto refused = [](const std::function<void(StartParams&)>& spoil) {
    StartParams spoilt = params();
    spoil(spoilt);
    EXPECT_THROW(StartGuard(spoilt, {"left", "right"}), std::invalid_argument);
  };
  refused([](StartParams& p) { p.ready = Eigen::Vector3d::Zero(); });
  refused([](StartParams& p) { p.ready[0] = std::nan(""); });
  refused([](StartParams& p) { p.distance = 0.0; });
  refused([](StartParams& p) { p.speed = 0.0; });
  refused([](StartParams& p) { p.speed = std::nan(""); });
}

}  // namespace
}  // namespace prf_drivers
