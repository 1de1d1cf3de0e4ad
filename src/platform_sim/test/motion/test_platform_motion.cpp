// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/platform_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

namespace platform_sim {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

TEST(PlatformMotion, StaysAtRestWithoutMotion) {
  const PlatformMotion motion("none", 7);
  for (double time = -1.0; time < 30.0; time += 0.37) {
    EXPECT_TRUE(motion.deck(time).pose.isApprox(Eigen::Isometry3d::Identity(), 1e-15));
    EXPECT_EQ(motion.deck(time).linear.norm(), 0.0);
    EXPECT_EQ(motion.deck(time).angular.norm(), 0.0);
  }
}

TEST(PlatformMotion, StartsAtRestWhateverTheSeed) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const FrameState deck = PlatformMotion("heavy", seed).deck(1e-9);
    EXPECT_LT(deck.pose.translation().norm(), 1e-9);
    EXPECT_LT(deck.linear.norm() + deck.angular.norm(), 1e-8);
  }
}

// The pitch rate is computed from the lag's equation, so this also proves the closed form of pitch.
TEST(PlatformMotion, TwistIsTheDerivativeOfThePose) {
  constexpr double kStep = 1e-5;
  std::vector<std::string> motions = preset_names();
  for (const char* family : {"heavy:2.5", "sea:1.5", "bursts:2.75", "stop:2"})
    motions.emplace_back(family);
  for (const std::string& preset : motions) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const PlatformMotion motion(preset, seed);
      for (double time = -0.5; time < 12.0; time += 0.0917) {
        const FrameState before = motion.deck(time - kStep);
        const FrameState after = motion.deck(time + kStep);
        const FrameState deck = motion.deck(time);
        const Eigen::Vector3d linear =
            (after.pose.translation() - before.pose.translation()) / (2.0 * kStep);
        const Eigen::AngleAxisd turn(after.pose.linear() * before.pose.linear().transpose());
        const Eigen::Vector3d angular = turn.axis() * turn.angle() / (2.0 * kStep);
        EXPECT_LT((deck.linear - linear).norm(), 1e-7) << preset << " at " << time;
        EXPECT_LT((deck.angular - angular).norm(), 1e-7) << preset << " at " << time;
      }
    }
  }
}

TEST(PlatformMotion, PitchesAboutAnAxisBelowAndBehindTheDeck) {
  const Eigen::Vector3d axis(-0.1, 0.0, -0.16);
  const PlatformMotion motion("heavy");
  for (double time = 0.0; time < 10.0; time += 0.31) {
    const Eigen::Vector3d moved = motion.deck(time).pose * axis;
    EXPECT_LT(
        (moved - axis - Eigen::Vector3d(0.0, motion.axis(Axis::kSway, time).value, 0.0)).norm(),
        1e-15);
  }
}

// Amplitude and phase of a sine of the given rate over whole periods after the start.
template <typename Signal>
std::complex<double> line_of(const Signal& signal, double rate) {
  constexpr int kSamples = 4000;
  const double period = 2.0 * 3.14159265358979323846 / rate;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double time = 10.0 + period * i / kSamples;
    sum += signal(time) * std::polar(1.0, -rate * time);
  }
  return 2.0 * sum / static_cast<double>(kSamples);
}

// Measured on the real treadmill: sway 100 mm peak to peak, pitch -5.5..+5.2 deg, 0.64 rad later.
TEST(PlatformMotion, HeavyMovesAsTheMeasuredDeckDid) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const PlatformMotion motion("heavy", seed);
    const auto sway =
        line_of([&](double time) { return motion.axis(Axis::kSway, time).value; }, 2.4);
    const auto pitch =
        line_of([&](double time) { return motion.axis(Axis::kPitch, time).value; }, 2.4);
    EXPECT_NEAR(std::abs(sway), 0.050, 1e-9);
    EXPECT_NEAR(std::abs(pitch), 5.4 * kDegree, 0.3 * kDegree);
    EXPECT_NEAR(std::arg(sway / pitch), 0.64, 0.02);
  }
}

TEST(PlatformMotion, LightMovesAsTheMeasuredDeckDid) {
  const PlatformMotion motion("light");
  const auto sway = line_of([&](double time) { return motion.axis(Axis::kSway, time).value; }, 2.0);
  const auto pitch =
      line_of([&](double time) { return motion.axis(Axis::kPitch, time).value; }, 1.5);
  EXPECT_NEAR(std::abs(sway), 0.050, 1e-9);
  EXPECT_NEAR(std::abs(pitch), 2.6 * kDegree, 0.15 * kDegree);
}

TEST(PlatformMotion, SeedDecidesThePhase) {
  const double time = 5.0;
  EXPECT_EQ(PlatformMotion("light", 3).axis(Axis::kSway, time).value,
            PlatformMotion("light", 3).axis(Axis::kSway, time).value);
  EXPECT_NE(PlatformMotion("light", 3).axis(Axis::kSway, time).value,
            PlatformMotion("light", 4).axis(Axis::kSway, time).value);
  EXPECT_NE(PlatformMotion("light", 3).axis(Axis::kSway, time).value,
            PlatformMotion("light").axis(Axis::kSway, time).value);
}

TEST(PlatformMotion, RefusesUnknownPresetAndNamesTheValidOnes) {
  try {
    const PlatformMotion motion("stormy");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "motion is \"stormy\": must be one of: none, as_printed, as_printed_heavy, heavy, "
                 "light, ship, ship_sea_state, ship_underway, heavy:LEVEL, sea:LEVEL, "
                 "bursts:LEVEL, stop:LEVEL, or a file .yaml or .csv");
  }
}

}  // namespace
}  // namespace platform_sim
