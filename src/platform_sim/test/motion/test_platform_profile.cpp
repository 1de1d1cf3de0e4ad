// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/platform_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "platform_sim/platform_motion.hpp"
#include "temporary_file.hpp"

namespace platform_sim {
namespace {

std::string complaint_about(const std::string& text, const std::string& ending) {
  const TemporaryFile file(text, ending);
  return refusal([&] { (void)find_profile(file.path()); });
}

TEST(PlatformProfile, AsPrintedIsThePapersLightMotionTakenLiterally) {
  const PlatformProfile profile = find_profile("as_printed");
  EXPECT_TRUE(profile.carries_base);
  const Sine& sway = profile.axes[static_cast<std::size_t>(Axis::kSway)].sines.at(0);
  EXPECT_NEAR(sway.amplitude * sway.rate, 6.28, 0.01);
  EXPECT_NEAR(sway.amplitude * sway.rate * sway.rate / 9.81, 8.0, 0.1);
  EXPECT_NO_THROW(profile.validate());
}

TEST(PlatformProfile, PresetsAreWithinTheBoundsAndOnlyAsPrintedCarriesTheBase) {
  for (const std::string& name : preset_names()) {
    EXPECT_NO_THROW(find_profile(name).validate()) << name;
    EXPECT_EQ(find_profile(name).carries_base, name.rfind("as_printed", 0) == 0) << name;
  }
}

// Their amplitudes add up to 0.225 rad and 0.082 m, their sum never reaches 0.18.
TEST(PlatformProfile, WhatTheSinesReachTogetherIsBoundedNotTheSumOfTheirAmplitudes) {
  const PlatformProfile ship = find_profile("ship_underway");
  double sum = 0.0, reached = 0.0;
  for (const Sine& sine : ship.axes[static_cast<std::size_t>(Axis::kPitch)].sines)
    sum += sine.amplitude;
  const PlatformMotion motion("ship_underway", 3);
  for (double time = 3.0; time < 120.0; time += 0.02)
    reached = std::max(reached, std::abs(motion.axis(Axis::kPitch, time).value));
  EXPECT_NEAR(sum, 0.225, 0.001);
  EXPECT_NEAR(reached, 0.174, 0.001);
  const std::string said = complaint_about(
      "pitch: {sines: [{amplitude: 0.1, rate: 1, phase: 0}, {amplitude: 0.1, rate: 1.31, phase: "
      "1}]}",
      ".yaml");
  EXPECT_NE(said.find("pitch amplitude = 0.19"), std::string::npos) << said;
}

TEST(PlatformProfile, ExamplesMoveTheDeckAsTheySayAndAllAxesDifferentiateRight) {
  const std::string ship = std::string(CONFIG_DIR) + "/profiles/ship.yaml";
  EXPECT_TRUE(
      find_profile(std::string(CONFIG_DIR) + "/profiles/as_printed_heavy.yaml").carries_base);
  const PlatformMotion motion(ship, 4);
  constexpr double kStep = 1e-5;
  Eigen::Vector3d farthest = Eigen::Vector3d::Zero(), widest = Eigen::Vector3d::Zero();
  for (double time = 0.0; time < 30.0; time += 0.0917) {
    const FrameState before = motion.deck(time - kStep), after = motion.deck(time + kStep);
    const FrameState deck = motion.deck(time);
    const Eigen::Vector3d linear =
        (after.pose.translation() - before.pose.translation()) / (2.0 * kStep);
    const Eigen::AngleAxisd turn(after.pose.linear() * before.pose.linear().transpose());
    EXPECT_LT((deck.linear - linear).norm(), 1e-6) << time;
    EXPECT_LT((deck.angular - turn.axis() * turn.angle() / (2.0 * kStep)).norm(), 1e-6) << time;
    for (int i = 0; i < 3; ++i) {
      farthest[i] = std::max(farthest[i], std::abs(motion.axis(static_cast<Axis>(i), time).value));
      widest[i] = std::max(widest[i], std::abs(motion.axis(static_cast<Axis>(3 + i), time).value));
    }
  }
  EXPECT_EQ(farthest[0], 0.0);
  EXPECT_NEAR(farthest[1], 0.04, 0.005);
  EXPECT_NEAR(farthest[2], 0.02, 0.001);
  EXPECT_NEAR(widest[0], 0.05 / std::sqrt(1.0 + 0.26 * 0.26), 0.003);
  EXPECT_NEAR(widest[2], 0.02, 0.001);
}

TEST(PlatformProfile, PlaysARecordedDeck) {
  std::ostringstream text;
  text << "time,pitch,sway\n";
  for (int i = 0; i <= 800; ++i) {
    const double t = 0.01 * i;
    text << t << "," << 0.05 * std::sin(1.5 * t) << "," << 0.04 * std::sin(2.0 * t) << "\n";
  }
  const TemporaryFile file(text.str(), ".csv");
  const PlatformMotion motion(file.path(), 3);
  EXPECT_FALSE(motion.carries_base());
  for (double time = 2.0; time < 8.0; time += 0.1) {
    EXPECT_NEAR(motion.axis(Axis::kSway, time).value, 0.04 * std::sin(2.0 * (time - 0.5)), 1e-5);
    EXPECT_NEAR(motion.axis(Axis::kPitch, time).value, 0.05 * std::sin(1.5 * (time - 0.5)), 1e-5);
    EXPECT_EQ(motion.axis(Axis::kYaw, time).value, 0.0);
  }
  EXPECT_LT(motion.deck(1e-9).linear.norm(), 1e-8);
}

TEST(PlatformProfile, RefusesMotionBeyondATreadmillAndNamesAxisValueAndBound) {
  const std::vector<std::pair<std::string, std::string>> faults{
      {"sway: {sines: [{amplitude: 0.5, rate: 0.5, phase: 0}]}",
       "sway amplitude = 0.5, must be at most 0.1 m"},
      {"sway: {sines: [{amplitude: 0.08, rate: 1, phase: 0}, {amplitude: 0.03, rate: 3, phase: "
       "3.1415927}]}",
       "sway amplitude = 0.11, must be at most 0.1 m"},
      {"heave: {sines: [{amplitude: 0.09, rate: 6, phase: 0}]}",
       "heave velocity = 0.54, must be at most 0.5 m/s"},
      {"surge: {sines: [{amplitude: 0.01, rate: 20, phase: 0}]}",
       "surge acceleration = 4, must be at most 2.5 m/s2"},
      {"pitch: {sines: [{amplitude: 0.3, rate: 1, phase: 0}]}",
       "pitch amplitude = 0.3, must be at most 0.18 rad"},
      {"base: carried\nroll: {sines: [{amplitude: 0.3, rate: 30, phase: 0}]}",
       "roll velocity = 9, must be at most 5 rad/s"},
  };
  for (const auto& [text, complaint] : faults) {
    const std::string said = complaint_about(text, ".yaml");
    EXPECT_NE(said.find(complaint), std::string::npos) << said;
  }
}

// Fault 43, 52: amplitudes, rates, phases, lags beyond physical bounds -> refused by name
TEST(PlatformProfile, RefusesNumbersThatNoMotionHas) {
  for (const std::string number : {".nan", ".inf", "1e308", "-1e308", "1e5"}) {
    for (const std::string name : {"amplitude", "rate", "phase"}) {
      std::string sine = "amplitude: 0, rate: 1, phase: 0";
      const std::size_t at = sine.find(name) + name.size() + 2;
      sine.replace(at, 1, number);
      const std::string said = complaint_about("sway: {sines: [{" + sine + "}]}", ".yaml");
      EXPECT_NE(said.find("sway " + name), std::string::npos) << number << " -> " << said;
    }
    const std::string said = complaint_about("sway: {lag: " + number + ", sines: []}", ".yaml");
    EXPECT_NE(said.find("sway lag"), std::string::npos) << said;
  }
  std::string many;
  for (int i = 0; i <= 1000; ++i) many += "{amplitude: 0, rate: 1, phase: 0}, ";
  EXPECT_NE(complaint_about("sway: {sines: [" + many + "]}", ".yaml").find("at most 1000"),
            std::string::npos);
}

TEST(PlatformProfile, RefusesFilesThatItCannotRead) {
  const std::vector<std::pair<std::string, std::string>> faults{
      {"swing: {sines: []}", "no key 'swing'"},
      {"sway: {sinus: []}", "no key 'sinus'"},
      {"sway: {lag: 1}", "has no list `sines`"},
      {"sway: {sines: [{amplitude: 0.1, rate: 1}]}", "lacks phase"},
      {"sway: {sines: [{amplitude: much, rate: 1, phase: 0}]}",
       "amplitude is \"much\", must be a number"},
      {"sway: {sines: [{amplitude: .nan, rate: 1, phase: 0}]}", "sway amplitude = nan"},
      {"sway: {sines: [{amplitude: 0.01, rate: -1, phase: 0}]}", "sway rate = -1"},
      {"sway: {lag: -1, sines: []}", "sway lag = -1"},
      {"base: floating", "base = \"floating\", must be free or carried"},
      {"[1, 2]", "must be a map"},
      {"sway: {", "motion is"},
  };
  for (const auto& [text, complaint] : faults) {
    const std::string said = complaint_about(text, ".yaml");
    EXPECT_NE(said.find(complaint), std::string::npos) << text << " -> " << said;
  }
  const std::string rows = "0,0\n0.5,0\n1,0.2\n1.5,0\n";
  EXPECT_NE(complaint_about("time,tilt\n" + rows, ".csv").find("column \"tilt\""),
            std::string::npos);
  EXPECT_NE(complaint_about("time,sway\n" + rows, ".csv").find("sway amplitude = 0.2, must be"),
            std::string::npos);
  EXPECT_NE(complaint_about("time,sway\n0,0\n0.5,nan\n1,0\n2,0\n", ".csv").find("line 3: sway"),
            std::string::npos);
  EXPECT_NE(refusal([] { (void)find_profile("absent.yaml"); }).find("absent.yaml"),
            std::string::npos);
}

}  // namespace
}  // namespace platform_sim
