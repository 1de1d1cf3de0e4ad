// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/cart_push.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(CartPush, MovesTheCartOnceByItsDistanceAlongItsHeading) {
  const CartPush push({3.0, 2.0, 0.2, 1.1});
  EXPECT_TRUE(push.cart(-5.0).pose.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(push.cart(3.0).pose.isApprox(Eigen::Isometry3d::Identity()));
  for (const double time : {5.0, 6.0, 1e6}) {
    const FrameState cart = push.cart(time);
    EXPECT_NEAR(cart.pose.translation().x(), 0.2 * std::cos(1.1), 1e-15);
    EXPECT_NEAR(cart.pose.translation().y(), 0.2 * std::sin(1.1), 1e-15);
    EXPECT_EQ(cart.linear.norm(), 0.0);
  }
}

TEST(CartPush, IsSmoothWithTheVelocityOfItsPath) {
  const CartPush push({3.0, 2.0, 0.2, -1.4});
  constexpr double kStep = 1e-5;
  double fastest = 0.0;
  for (double time = 2.9; time < 5.1; time += 0.01) {
    const Eigen::Vector3d moved =
        push.cart(time + kStep).pose.translation() - push.cart(time - kStep).pose.translation();
    EXPECT_LT((moved / (2.0 * kStep) - push.cart(time).linear).norm(), 1e-7);
    fastest = std::max(fastest, push.cart(time).linear.norm());
  }
  EXPECT_NEAR(fastest, 1.875 * 0.2 / 2.0, 1e-5);  // of a least-jerk reach
}

TEST(CartPush, IsDrawnFromTheSeedWithinItsRanges) {
  std::set<double> distances;
  int to_the_left = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const CartPush::Params push = CartPush::draw(seed);
    EXPECT_EQ(push.start, CartPush::draw(seed).start);
    EXPECT_TRUE(push.start >= 2.0 && push.start <= 5.0);
    EXPECT_TRUE(push.duration >= 2.0 && push.duration <= 3.0);
    EXPECT_TRUE(push.distance >= 0.10 && push.distance <= 0.15);
    EXPECT_LE(std::abs(std::abs(push.heading) - kPi / 2.0), kPi / 9.0);
    distances.insert(push.distance);
    to_the_left += push.heading > 0.0 ? 1 : 0;
  }
  EXPECT_EQ(distances.size(), 200u);
  EXPECT_NEAR(to_the_left, 100, 30);
}

TEST(CartPush, RefusesWhatIsNoPush) {
  const std::vector<std::function<void(CartPush::Params&)>> faults{
      [](auto& push) { push.start = -1.0; },
      [](auto& push) { push.duration = 0.0; },
      [](auto& push) { push.distance = 1.1; },
      [](auto& push) { push.heading = std::nan(""); },
  };
  for (const auto& fault : faults) {
    CartPush::Params push;
    fault(push);
    EXPECT_THROW(CartPush{push}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace platform_sim
