// SPDX-License-Identifier: BSD-3-Clause
#include "robot_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "platform_sim/put_robot.hpp"
#include "v60_gait/leg_sensors.hpp"
#include "v60_gait/operator.hpp"

namespace motion_capture {
namespace {

std::string robot_urdf() {
  std::ifstream file(std::string(ROBOT_FOLDER) + "/robot.urdf");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

constexpr double kPi = 3.14159265358979323846;

platform_sim::WorldParams ready_robot(const std::string& motion, const std::string& gait) {
  platform_sim::WorldParams config;
  platform_sim::put_robot(ROBOT_FOLDER, &config);
  config.motion = motion;
  config.gait = gait;
  config.seed = 3;
  config.arm_start << 1.441, 1.595, 0.709, 1.019, -1.276, 2.240, -0.631;
  return config;
}

MotionPiece observe(platform_sim::World& world, double settling, double duration) {
  MotionObserver observer;
  while (world.time() < settling + duration && !world.fallen()) observer.step(world);
  const auto first = static_cast<std::ptrdiff_t>(std::lround(100.0 * settling));
  return {observer.samples().begin() + first, observer.samples().end()};
}

// Amplitude of the body's pitch against the deck per amplitude of the deck's, at the heavy rate.
double levelling(const std::string& gait) {
  platform_sim::World world(robot_urdf(), ready_robot("heavy", gait));
  MotionPiece samples = observe(world, 4.0, 2.0 * kPi / 2.4);
  for (MotionSample& sample : samples) {
    sample.tag = {sample.roll_pitch_yaw.y(), sample.deck_pitch, 0.0};
  }
  const Eigen::Matrix3Xd lines = tag_lines({samples}, {2.4});
  return lines(0, 0) / lines(1, 0);
}

TEST(RobotMotion, MeasuresASineAndItsLine) {
  constexpr double kAmplitude = 0.05, kRate = 4.0;
  MotionPiece piece;
  for (int i = 0; i < 1000; ++i) {
    MotionSample sample;
    sample.time = 0.01 * i;
    sample.tag.y() = kAmplitude * std::sin(kRate * sample.time + 0.3);
    piece.push_back(sample);
  }
  const MotionFigures figures = measure_motion({piece});
  EXPECT_NEAR(figures.tag_range.y(), 2.0 * kAmplitude, 1e-4);
  EXPECT_NEAR(figures.tag_speed_rms, kAmplitude * kRate / std::sqrt(2.0),
              0.02 * kAmplitude * kRate);
  EXPECT_EQ(figures.cadence, 0.0);
  const Eigen::Matrix3Xd lines = tag_lines({piece}, {kRate});
  EXPECT_NEAR(lines(1, 0), kAmplitude, 1e-9);
  EXPECT_NEAR(lines(1, 1), 0.0, 1e-9);
}

TEST(RobotMotion, CountsStepsThatLiftTheToeByTwelveMillimetres) {
  MotionPiece piece;
  for (int i = 0; i < 800; ++i) {
    MotionSample sample;
    sample.time = 0.01 * i;
    const double phase = std::fmod(sample.time, 0.8) / 0.8;
    const double height = phase < 0.6 ? 0.0 : 0.13 * std::sin(kPi * (phase - 0.6) / 0.4);
    sample.toe_heights.setConstant(0.02 + height);
    piece.push_back(sample);
  }
  const MotionFigures figures = measure_motion({piece});
  EXPECT_NEAR(figures.cadence, 1.25, 0.01);
  EXPECT_NEAR(figures.duty, 0.6 + 0.8 * std::asin(0.012 / 0.13) / kPi, 0.02);
  EXPECT_NEAR(figures.lift, 0.13, 0.002);
}

TEST(RobotMotion, RefusesPiecesWithoutSamples) {
  EXPECT_THROW((void)measure_motion({}), std::invalid_argument);
  EXPECT_THROW((void)measure_motion({MotionPiece(9)}), std::invalid_argument);
}

TEST(Legs, LevelTheBodyByHalfOfTheDecksPitchUnlessTheyAreStiff) {
  EXPECT_NEAR(levelling("stand"), 0.5, 0.12);
  EXPECT_LT(levelling("stand_stiff"), 0.2);
}

TEST(Legs, TrotAtTheMeasuredCadenceWithDiagonalPairs) {
  platform_sim::World world(robot_urdf(), ready_robot("light", "step"));
  const MotionPiece piece = observe(world, 4.0, 6.0);
  const MotionFigures figures = measure_motion({piece});
  EXPECT_NEAR(figures.cadence, 1.34, 0.04);
  EXPECT_NEAR(figures.duty, 0.60, 0.05);
  EXPECT_NEAR(figures.lift, 0.131, 0.015);
  int diagonal = 0, lifted = 0;
  for (const MotionSample& sample : piece) {
    const auto up = (sample.toe_heights.array() > 0.05).eval();
    lifted += static_cast<int>(up.any());
    diagonal += static_cast<int>(up.any() && up[0] == up[3] && up[1] == up[2] && up[0] != up[1]);
  }
  EXPECT_GT(diagonal, 0.9 * lifted);
}

TEST(Legs, StartToTrotWithoutThrowingTheBodyAside) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    platform_sim::WorldParams config = ready_robot("none", "step");
    config.seed = seed;
    platform_sim::World world(robot_urdf(), config);
    double farthest = 0.0;
    const MotionPiece piece = observe(world, 0.0, 3.0);
    for (const MotionSample& sample : piece) {
      farthest = std::max(farthest, (sample.body - piece.front().body).norm());
    }
    EXPECT_LT(farthest, 0.020) << "seed " << seed;
  }
}

TEST(Legs, TrotOnWhenTheRobotIsPushedOrCarriesAPayload) {
  platform_sim::World world(robot_urdf(), ready_robot("light", "step"));
  MotionObserver observer;
  const auto disturb = [](platform_sim::World& now) {
    now.push(now.robot().hand, {0.0, 0.0, -15.0});
    const double since = std::fmod(now.time(), 2.0);
    if (now.time() < 2.0 || since > 0.2) return;
    now.push(now.time() < 4.0 ? now.robot().hand : now.base_link(), {0.0, -80.0, 0.0});
  };
  while (world.time() < 7.0) observer.step(world, disturb);
  EXPECT_FALSE(world.fallen());
  double farthest = 0.0;
  for (const MotionSample& sample : observer.samples()) {
    farthest = std::max(farthest, std::abs(sample.body.y()));
  }
  EXPECT_GT(farthest, 0.05);
}

// A hand that accelerates by 1 m/s2 may not move the body so that the target moves as much again;
// seen in the difference to the same run with the arm at rest.
TEST(Legs, StepWithoutBeingExcitedByTheArm) {
  const double rate = 2.0 * kPi * 1.6;
  const platform_sim::WorldParams config = ready_robot("none", "step");
  platform_sim::World world(robot_urdf(), config);
  platform_sim::World still(robot_urdf(), config);
  MotionObserver observer, still_observer;
  MotionPiece hand;
  while (world.time() < 6.0) {
    platform_sim::ArmVector positions = config.arm_start;
    platform_sim::ArmVector velocities = platform_sim::ArmVector::Zero(7);
    positions[1] += 0.016 * std::sin(rate * world.time());
    velocities[1] = 0.016 * rate * std::cos(rate * world.time());
    world.command_arm(positions, velocities);
    observer.step(world);
    still_observer.step(still);
    hand.push_back(observer.samples().back());
    hand.back().tag =
        world.base().pose.inverse() * world.frame(world.robot().hand).pose.translation();
  }
  MotionPiece tag = observer.samples();
  for (std::size_t i = 0; i < tag.size(); ++i) tag[i].tag -= still_observer.samples()[i].tag;
  hand.erase(hand.begin(), hand.begin() + 200);
  tag.erase(tag.begin(), tag.begin() + 200);
  const double moved = tag_lines({hand}, {rate}).col(0).norm();
  EXPECT_GT(moved, 0.004);
  EXPECT_LT(tag_lines({tag}, {rate}).col(0).norm(), 0.5 * moved);
}

// The heavy deck pitches by 5.4 degrees and accelerates by 0.3 m/s2: that takes a friction of 0.1
// to 0.15, with what the body adds.
TEST(Legs, SlideOnlyIfTheFrictionIsLessThanTheDeckAsksFor) {
  const auto slip = [](double friction) {
    platform_sim::WorldParams config = ready_robot("heavy", "stand");
    config.friction = friction;
    platform_sim::World world(robot_urdf(), config);
    MotionObserver observer;
    while (world.time() < 5.0) observer.step(world);
    return observer.slip();
  };
  EXPECT_GT(slip(0.1), 0.050);
  EXPECT_LT(slip(0.2), 0.002);
}

TEST(Legs, FallWhenTheDeckIsIce) {
  platform_sim::WorldParams config = ready_robot("heavy", "step");
  config.friction = 0.05;
  platform_sim::World world(robot_urdf(), config);
  (void)observe(world, 0.0, 20.0);
  EXPECT_TRUE(world.fallen());
}

}  // namespace
}  // namespace motion_capture
