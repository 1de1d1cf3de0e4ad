// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/motion_guards.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "small_arm.hpp"

namespace prf_drivers {
namespace {

GuardsParams params() {
  GuardsParams result;
  result.joints = kSmallArm;
  result.start = {three(0.0, 0.5, 0.5), 0.3, 0.5, std::chrono::milliseconds(50)};
  result.effort = {three(-1, -1, -1), three(1, 1, 1), 0.0};
  result.base_link = "base";
  result.workspace = {-1.2, -1.2, -1.0, 1.2, 1.2, 1.0};
  result.self_collision = true;
  result.joint_bounds = true;
  result.clearance = {0.02, 0.1};
  result.urdf = small_arm();
  return result;
}

Allowance ask(MotionGuards& guards, const Eigen::VectorXd& rest, double effort = 0.0) {
  Measured measured(three(0.0, 0.5, 0.5));
  measured.effort = three(effort, 0.0, 0.0);
  return guards.allow({prf_core::Stamp(1), measured, rest});
}

TEST(MotionGuards, SayTheGravestOfWhatTheyFind) {
  MotionGuards guards(params());
  EXPECT_EQ(ask(guards, three(0.0, 0.5, 0.5)).speed, 0.5);  // slow at the start
  EXPECT_EQ(ask(guards, three(0.0, 2.3, 2.3)).code, MotionCode::kHaltsForCollision);
  EXPECT_EQ(ask(guards, three(0.0, 2.6, 0.0)).code, MotionCode::kJointBound);
  EXPECT_EQ(ask(guards, three(0.0, 0.5, 0.5), 2.0).code, MotionCode::kProtectiveStop);
  EXPECT_TRUE(ask(guards, three(0.0, 0.5, 0.5)).hold);
  guards.reset();
  EXPECT_FALSE(ask(guards, three(0.0, 0.5, 0.5)).hold);
}

TEST(MotionGuards, KeepTheSlowestSpeed) {
  MotionGuards guards(params());
  guards.goes_forward(prf_core::Stamp(-100'000'000));
  EXPECT_EQ(ask(guards, three(0.0, 0.5, 0.5)).speed, 1.0);
  EXPECT_LT(ask(guards, three(0.0, 0.0, 0.2)).speed, 0.9);  // the workspace's wall
}

TEST(MotionGuards, NeedNoDescriptionForWhatDoesNotLookAtIt) {
  GuardsParams plain = params();
  plain.workspace.clear();
  plain.self_collision = plain.joint_bounds = false;
  plain.urdf.clear();
  EXPECT_FALSE(plain.needs_urdf());
  MotionGuards guards(plain);
  EXPECT_FALSE(ask(guards, three(0.0, 9.0, 9.0)).hold);
}

TEST(MotionGuards, RefuseWhatDoesNotFitTogether) {
  const auto refused = [](const std::function<void(GuardsParams&)>& spoil) {
    GuardsParams spoilt = params();
    spoil(spoilt);
    EXPECT_THROW(MotionGuards{spoilt}, std::invalid_argument);
  };
  refused([](GuardsParams& p) { p.start.ready.resize(0); });  // self_collision needs it
  refused([](GuardsParams& p) { p.workspace = {0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1}; });
  refused([](GuardsParams& p) { p.base_link = "hip"; });
  refused([](GuardsParams& p) { p.clearance.slow_distance = 0.0; });
  refused([](GuardsParams& p) { p.urdf = "no robot"; });
}

}  // namespace
}  // namespace prf_drivers
