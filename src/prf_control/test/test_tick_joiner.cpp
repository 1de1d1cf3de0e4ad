// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/tick_joiner.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace prf_control {
namespace {

constexpr prf_core::Duration kTick = std::chrono::milliseconds(10);

JointSample tick_at(prf_core::Stamp stamp) {
  return {stamp, JointVector(JointVector::Zero(7)), ""};
}

Setpoint tagged(double tag) {
  return checked_setpoint({tag, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}, Eigen::Vector3d::Zero(),
                          Eigen::Vector3d::Zero());
}

struct Tagged {
  prf_core::Stamp stamp;
  double tag;  // -1: no set-point
  bool new_run;
  bool operator==(const Tagged& other) const {
    return stamp == other.stamp && tag == other.tag && new_run == other.new_run;
  }
};

std::vector<Tagged> drain(TickJoiner& joiner) {
  std::vector<Tagged> joined;
  while (const auto tick = joiner.next()) {
    const double tag =
        tick->secondary ? tick->secondary->pose.hand_in_base.translation().x() : -1.0;
    joined.push_back({tick->stamp, tag, tick->new_run});
  }
  return joined;
}

TEST(TickJoiner, WaitsForTheSetpointOfTheSameStamp) {
  TickJoiner joiner(30 * kTick);
  joiner.add_joints(tick_at(5 * kTick));
  EXPECT_TRUE(drain(joiner).empty());
  joiner.add_setpoint(5 * kTick, tagged(5.0));
  EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{5 * kTick, 5.0, false}}));
  EXPECT_TRUE(drain(joiner).empty());
}

TEST(TickJoiner, GoesOnWithoutASetpointWhenALaterOneHasCome) {
  TickJoiner joiner(30 * kTick);
  joiner.add_joints(tick_at(1 * kTick));
  joiner.add_setpoint(2 * kTick, tagged(2.0));
  EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{1 * kTick, -1.0, false}}));
  joiner.add_joints(tick_at(2 * kTick));
  EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{2 * kTick, 2.0, false}}));
  EXPECT_EQ(joiner.counts().missing_setpoints, 1u);
}

TEST(TickJoiner, GivesUpByDataTimeAndJoinsAgainWhenSetpointsCome) {
  TickJoiner joiner(3 * kTick);
  for (int i = 0; i <= 3; ++i) joiner.add_joints(tick_at(i * kTick));
  EXPECT_TRUE(drain(joiner).empty());
  joiner.add_joints(tick_at(4 * kTick));
  EXPECT_EQ(drain(joiner).size(), 5u);
  joiner.add_joints(tick_at(5 * kTick));
  EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{5 * kTick, -1.0, false}}));
  EXPECT_EQ(joiner.counts().silences, 1u);

  joiner.add_setpoint(5 * kTick, tagged(5.0));
  EXPECT_EQ(joiner.counts().late_setpoints, 1u);
  joiner.add_joints(tick_at(6 * kTick));
  EXPECT_TRUE(drain(joiner).empty());
  joiner.add_setpoint(6 * kTick, tagged(6.0));
  EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{6 * kTick, 6.0, false}}));
}

TEST(TickJoiner, IgnoresASecondTickOrSetpointOfOneStamp) {
  TickJoiner joiner(30 * kTick);
  joiner.add_joints(tick_at(kTick));
  joiner.add_joints(tick_at(kTick));
  joiner.add_setpoint(2 * kTick, tagged(1.0));
  joiner.add_setpoint(2 * kTick, tagged(2.0));
  joiner.add_joints(tick_at(2 * kTick));
  EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{kTick, -1.0, false}, {2 * kTick, 1.0, false}}));
  EXPECT_EQ(joiner.counts().duplicate_ticks, 1u);
  EXPECT_EQ(joiner.counts().late_setpoints, 1u);
}

// Both topics in their own order, interleaved at random, neither more than max_wait behind.
std::vector<Tagged> run_interleaved(unsigned seed) {
  constexpr int kTicks = 500;
  std::mt19937 random(seed);
  TickJoiner joiner(30 * kTick);
  std::vector<Tagged> joined;
  int ticks = 0;
  int setpoints = 0;
  while (ticks < kTicks || setpoints < kTicks) {
    const int lead = ticks - setpoints;
    const bool tick_next =
        setpoints == kTicks || lead <= -25 || (lead < 25 && ticks < kTicks && random() % 2 == 0);
    if (tick_next) {
      joiner.add_joints(tick_at(kTick * ++ticks));
    } else {
      ++setpoints;
      if (setpoints % 7 != 0) joiner.add_setpoint(kTick * setpoints, tagged(setpoints));
    }
    for (const Tagged& tick : drain(joiner)) joined.push_back(tick);
  }
  return joined;
}

TEST(TickJoiner, JoinsTheSameWhateverTheInterleaving) {
  const std::vector<Tagged> first = run_interleaved(0);
  ASSERT_EQ(first.size(), 500u);
  for (const Tagged& tick : first) {
    const auto index = tick.stamp / kTick;
    EXPECT_EQ(tick.tag, index % 7 == 0 ? -1.0 : static_cast<double>(index));
  }
  for (unsigned seed = 1; seed < 200; ++seed) ASSERT_EQ(run_interleaved(seed), first) << seed;
}

// The order in which the two topics show that a new run has begun must not matter either.
TEST(TickJoiner, BeginsANewRunWhenTicksGoBackInTime) {
  for (const bool setpoint_first : {true, false}) {
    TickJoiner joiner(30 * kTick);
    for (int i = 200; i < 210; ++i) {
      joiner.add_joints(tick_at(i * kTick));
      if (i < 209) joiner.add_setpoint(i * kTick, tagged(i));
    }
    EXPECT_EQ(drain(joiner).size(), 9u);
    for (const int i : {-2, -1}) joiner.add_joints(tick_at(i * kTick));
    EXPECT_EQ(joiner.counts().old_ticks, 2u);
    if (setpoint_first) joiner.add_setpoint(0 * kTick, tagged(0.5));
    joiner.add_joints(tick_at(0 * kTick));
    if (!setpoint_first) joiner.add_setpoint(0 * kTick, tagged(0.5));
    EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{0 * kTick, 0.5, true}})) << setpoint_first;
    joiner.add_joints(tick_at(kTick));
    EXPECT_TRUE(drain(joiner).empty());
    joiner.add_setpoint(kTick, tagged(1.5));
    EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{kTick, 1.5, false}}));
    EXPECT_EQ(joiner.counts().new_runs, 1u);
  }
}

TEST(TickJoiner, ForgetsSetpointsOfTheLastRun) {
  TickJoiner joiner(30 * kTick);
  joiner.add_joints(tick_at(203 * kTick));
  joiner.add_setpoint(204 * kTick, tagged(4.0));
  EXPECT_EQ(drain(joiner).size(), 1u);
  joiner.add_setpoint(205 * kTick, tagged(5.0));
  for (int i = -1; i <= 1; ++i) joiner.add_joints(tick_at(i * kTick));
  for (int i = 2; i <= 4; ++i) joiner.add_joints(tick_at(i * kTick));
  EXPECT_TRUE(drain(joiner).empty());
  EXPECT_EQ(joiner.counts().new_runs, 1u);
}

TEST(TickJoiner, RecoversFromASetpointStampedFarInTheFuture) {
  TickJoiner joiner(30 * kTick);
  joiner.add_joints(tick_at(kTick));
  joiner.add_setpoint(1'000'000 * kTick, tagged(9.0));
  EXPECT_EQ(joiner.counts().far_ahead_setpoints, 1u);
  for (int i = 1; i <= 3; ++i) {
    if (i > 1) joiner.add_joints(tick_at(i * kTick));
    EXPECT_TRUE(drain(joiner).empty());
    joiner.add_setpoint(i * kTick, tagged(i));
    EXPECT_EQ(drain(joiner), (std::vector<Tagged>{{i * kTick, static_cast<double>(i), false}}));
  }
}

}  // namespace
}  // namespace prf_control
