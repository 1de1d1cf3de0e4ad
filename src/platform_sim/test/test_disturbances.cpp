// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/disturbances.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "temporary_file.hpp"
#include "v60_world.hpp"

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(Disturbances, AreDrawnFromTheSeedWithinTheirRanges) {
  std::set<std::string> links;
  std::set<double> times;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Disturbances drawn("push:60,stumble:2", seed), again("push:60+stumble:2", seed);
    ASSERT_EQ(drawn.forces().size(), 2u);
    EXPECT_TRUE(drawn.forces()[0].peak == again.forces()[0].peak);
    const Disturbances::Force& push = drawn.forces()[0];
    EXPECT_NEAR(push.peak.norm(), 60.0, 1e-9);
    EXPECT_TRUE(push.begin >= 3.0 && push.begin <= 9.0) << push.begin;
    EXPECT_TRUE(push.duration >= 0.2 && push.duration <= 0.5) << push.duration;
    EXPECT_LE(std::abs(push.peak.z()), 30.1);
    links.insert(push.link);
    links.insert(drawn.forces()[1].link);
    times.insert(push.begin);
  }
  EXPECT_EQ(links.size(), 6u);  // hand, body, four toes
  EXPECT_EQ(times.size(), 60u);
}

TEST(Disturbances, ActForTheirTimeAndSayWhat) {
  const Disturbances push("push_hand:40@2.5", 3);
  const Disturbances::Force& force = push.forces().at(0);
  EXPECT_EQ(force.link, "hand");
  EXPECT_EQ(force.begin, 2.5);
  EXPECT_EQ(Disturbances::share(force, 2.5), 0.0);
  EXPECT_NEAR(Disturbances::share(force, 2.5 + 0.5 * force.duration), 1.0, 1e-12);
  EXPECT_EQ(Disturbances::share(force, 2.5 + force.duration), 0.0);
  EXPECT_TRUE(push.acting(2.4).empty());
  const auto acting = push.acting(2.6);
  ASSERT_EQ(acting.size(), 1u);
  EXPECT_EQ(acting[0].word, "push_hand:40@2.5");
  EXPECT_EQ(acting[0].what.find("40 N on hand"), 0u) << acting[0].what;
}

TEST(Disturbances, PushesOfTheCartAddUpAndAreAsFastAsTheySay) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Disturbances both("cart:0.3@2,cart_toward:0.2@8", seed);
    EXPECT_TRUE(both.moves_cart());
    double fastest = 0.0;
    for (double time = 0.0; time < 7.0; time += 0.01)
      fastest = std::max(fastest, both.cart(time).linear.norm());
    EXPECT_TRUE(fastest >= 0.75 * 0.3 - 1e-3 && fastest <= 1.5 * 0.3) << fastest;
    const Eigen::Vector3d aside = both.cart(7.0).pose.translation();
    EXPECT_NEAR(aside.norm(), 0.3, 1e-12);
    EXPECT_LT(std::abs(std::abs(std::atan2(aside.y(), aside.x())) - kPi / 2.0), kPi / 6.0);
    const Eigen::Vector3d toward = both.cart(20.0).pose.translation() - aside;
    EXPECT_NEAR(toward.norm(), 0.2, 1e-12);
    EXPECT_LT(toward.x(), -0.2 * std::cos(kPi / 6.0) + 1e-12);
  }
}

// Fault 28, 52: a disturbance that is none or beyond its bounds -> refused by name
TEST(Disturbances, RefuseWhatIsNone) {
  for (const char* text :
       {"kick:3", "push", "push:", "push:-1", "push:nan", "push:201", "cart:0.5", "push:20@",
        "push:20@-1", "push:20@inf", "push:20,", ",", "stumble:1e308"}) {
    const std::string said = refusal([&] { (void)Disturbances(text, 1); });
    EXPECT_FALSE(said.empty()) << text;
  }
  EXPECT_NE(refusal([] { (void)Disturbances("kick:3", 1); }).find("stumble"), std::string::npos);
  std::string many = "push:20";
  for (int i = 0; i < 20; ++i) many += ",push:20";
  EXPECT_NE(refusal([&] { (void)Disturbances(many, 1); }).find("at most 20"), std::string::npos);
  WorldParams config = folded_arm();
  config.disturb = "cart:0.2";
  EXPECT_NE(refusal([&] { config.validate(); }).find("scenario cart"), std::string::npos);
  config.scenario = "cart";
  EXPECT_NO_THROW(config.validate());
}

double farthest(const World& still, const World& disturbed, const std::string& link) {
  return (still.frame(link).pose.translation() - disturbed.frame(link).pose.translation()).norm();
}

TEST(DisturbedWorld, APushMovesWhatItIsDoneToAndAStumblingFootSlips) {
  WorldParams config = folded_arm();
  config.seed = 5;
  World still(robot_urdf(), config);
  config.disturb = "push_hand:80@0.1";
  World hand(robot_urdf(), config);
  config.disturb = "push_body:150@0.1";
  World body(robot_urdf(), config);
  config.disturb = "stumble:2@0.1";
  World stumbling(robot_urdf(), config);
  const std::string toe = stumbling.disturbances().forces().at(0).link;
  double at_hand = 0.0, at_body = 0.0, at_toe = 0.0;
  for (int i = 0; i < 60; ++i) {
    for (World* world : {&still, &hand, &body, &stumbling}) run(*world, 0.01);
    at_hand = std::max(at_hand, farthest(still, hand, "j2s7s300_end_effector"));
    at_body = std::max(at_body, farthest(still, body, "base_link"));
    at_toe = std::max(at_toe, farthest(still, stumbling, toe));
  }
  EXPECT_GT(at_hand, 0.003);
  EXPECT_GT(at_body, 0.003);
  EXPECT_GT(at_toe, 0.01);
  EXPECT_FALSE(body.fallen());
}

TEST(DisturbedWorld, TheTargetOnAQuayRestsWhileThePlatformMoves) {
  WorldParams config = folded_arm();
  config.scenario = "quay";
  config.motion = "heavy";
  World world(robot_urdf(), config);
  const Eigen::Isometry3d tag = world.tag().pose;
  run(world, 2.0);
  EXPECT_TRUE(world.tag().pose.isApprox(tag, 1e-15));
  EXPECT_EQ(world.tag().linear.norm(), 0.0);
  EXPECT_GT(world.platform().pose.translation().norm(), 1e-3);
}

}  // namespace
}  // namespace platform_sim
