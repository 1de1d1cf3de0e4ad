// SPDX-License-Identifier: BSD-3-Clause
#include "motion/motion_families.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform_sim/platform_motion.hpp"
#include "temporary_file.hpp"

namespace platform_sim {
namespace {

// Largest magnitudes of an axis after the start's ramp: value, velocity, acceleration.
Eigen::Vector3d reach(const PlatformMotion& motion, Axis axis, double duration = 60.0) {
  constexpr double kStep = 0.01;
  Eigen::Vector3d most = Eigen::Vector3d::Zero();
  for (double time = 2.5; time < 2.5 + duration; time += kStep) {
    const auto now = motion.axis(axis, time);
    const double acceleration = (motion.axis(axis, time + 0.5 * kStep).velocity -
                                 motion.axis(axis, time - 0.5 * kStep).velocity) /
                                kStep;
    most = most.cwiseMax(Eigen::Vector3d(now.value, now.velocity, acceleration).cwiseAbs());
  }
  return most;
}

std::string text(const std::string& family, double level) {
  return family + ":" + std::to_string(level);
}

TEST(MotionFamilies, LevelOneOfHeavyIsHeavyToTheBit) {
  const PlatformMotion preset("heavy", 5), family("heavy:1", 5);
  for (double time = 0.0; time < 20.0; time += 0.173) {
    EXPECT_TRUE(preset.deck(time).pose.matrix() == family.deck(time).pose.matrix()) << time;
  }
}

TEST(MotionFamilies, NothingMovesAtLevelZero) {
  for (const std::string& family : family_names()) {
    const PlatformMotion motion(family + ":0", 3);
    for (double time = 0.0; time < 40.0; time += 0.37) {
      EXPECT_LT(motion.deck(time).linear.norm() + motion.deck(time).angular.norm(), 1e-12);
    }
  }
}

TEST(MotionFamilies, VelocitiesGoWithTheLevel) {
  for (const char* family : {"heavy", "sea"}) {
    for (const double level : {0.25, 2.5}) {
      for (const Axis axis : {Axis::kSway, Axis::kPitch}) {
        // 80 s are the sea's whole period at level 1.
        const double period = 80.0;
        const Eigen::Vector3d one = reach(PlatformMotion(text(family, 1.0), 4), axis, period);
        const Eigen::Vector3d some =
            reach(PlatformMotion(text(family, level), 4), axis, period / std::sqrt(level));
        EXPECT_NEAR(some[0] / one[0], std::sqrt(level), 0.02 * std::sqrt(level)) << family;
        EXPECT_NEAR(some[1] / one[1], level, 0.02 * level) << family;
      }
    }
  }
}

// Every seed may be sent: none is refused for what it happens to draw, and the bounds hold for what
// the deck really does, pattern and start included.
TEST(MotionFamilies, StayWithinThePlatformsBoundsAtTheHighestLevelWhateverTheSeed) {
  const Eigen::Vector3d linear(0.1, 0.5, 2.5), angular(0.18, 0.7, 3.0);
  for (const std::string& family : family_names()) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const PlatformMotion motion(text(family, kHighestLevel), seed);
      for (int axis = 0; axis < 6; ++axis) {
        const Eigen::Vector3d most = reach(motion, static_cast<Axis>(axis));
        const Eigen::Vector3d bound = axis < 3 ? linear : angular;
        EXPECT_TRUE((most.array() <= bound.array()).all())
            << family << " seed " << seed << " " << kAxisNames[static_cast<std::size_t>(axis)]
            << ": " << most.transpose();
      }
    }
  }
}

TEST(MotionFamilies, TheSeedDrawsTheSeaAndItsDirection) {
  const PlatformMotion motion("sea:1", 1);
  EXPECT_EQ(motion.axis(Axis::kRoll, 7.3).value,
            PlatformMotion("sea:1", 1).axis(Axis::kRoll, 7.3).value);
  double across = 0.0, along = 0.0;  // largest share of sway and of surge
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const PlatformMotion sea("sea:1", seed);
    const double sway = reach(sea, Axis::kSway)[1], surge = reach(sea, Axis::kSurge)[1];
    across = std::max(across, sway / (sway + surge));
    along = std::max(along, surge / (sway + surge));
  }
  EXPECT_GT(across, 0.7);
  EXPECT_GT(along, 0.7);
}

// The peak of the spectrum shows in the heave: most of its power is near 2 rad/s.
TEST(MotionFamilies, TheSeaHasItsPeakWhereTheSpectrumHas) {
  const PlatformProfile sea = sea_profile(find_profile("heavy"), 2);
  double near = 0.0, all = 0.0;
  for (const Sine& sine : sea.axes[static_cast<std::size_t>(Axis::kHeave)].sines) {
    const double power = sine.amplitude * sine.amplitude;
    all += power;
    if (std::abs(sine.rate - 2.0) < 0.4) near += power;
  }
  EXPECT_GT(near / all, 0.6);
  EXPECT_GT(sea.axes[static_cast<std::size_t>(Axis::kHeave)].sines.size(), 30u);
}

TEST(MotionFamilies, BurstsAreCalmThenFastThenCalm) {
  const PlatformMotion motion("bursts:2.5", 2);
  int calm = 0, fast = 0, changes = 0;
  bool was_fast = false;
  for (int second = 2; second < 58; ++second) {
    double most = 0.0;
    for (double time = second; time < second + 2.0; time += 0.05)
      most = std::max(most, std::abs(motion.axis(Axis::kSway, time).velocity));
    const bool is_fast = most > 0.2;
    calm += most < 0.1 ? 1 : 0;
    fast += is_fast ? 1 : 0;
    changes += is_fast != was_fast ? 1 : 0;
    was_fast = is_fast;
  }
  EXPECT_GT(calm, 5);
  EXPECT_GT(fast, 10);
  EXPECT_GE(changes, 5);
}

TEST(MotionFamilies, StopsStandStillAndStartAgain) {
  const PlatformMotion motion("stop:2", 2);
  int still = 0, moving = 0;
  for (double time = 3.0; time < 60.0; time += 0.1) {
    const FrameState deck = motion.deck(time);
    (deck.linear.norm() + deck.angular.norm() < 1e-12 ? still : moving) += 1;
  }
  EXPECT_GT(still, 60);
  EXPECT_GT(moving, 200);
}

// Fault 43: a level that is none, or beyond the platform -> refused by name
TEST(MotionFamilies, RefuseALevelThatIsNone) {
  for (const char* level : {"", "x", "1x", "nan", "inf", "-1", "2.76", "1e308", "1@3"}) {
    const std::string said = refusal([&] { (void)find_profile(std::string("heavy:") + level); });
    EXPECT_NE(said.find("motion is"), std::string::npos) << level;
    EXPECT_NE(said.find("heavy"), std::string::npos) << said;
  }
  EXPECT_NE(refusal([] { (void)find_profile("storm:1"); }).find("sea:LEVEL"), std::string::npos);
}

}  // namespace
}  // namespace platform_sim
