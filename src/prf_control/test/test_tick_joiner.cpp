// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/tick_joiner.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

namespace prf_control {
namespace {

constexpr std::int64_t kTick = 10'000'000;

JointSample tick_at(std::int64_t stamp_ns) {
  return {stamp_ns, JointVector(JointVector::Zero()), ""};
}

Setpoint tagged(double tag) {
  return checked_setpoint({tag, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}, Eigen::Vector3d::Zero(),
                          Eigen::Vector3d::Zero());
}

struct Outcome {
  std::int64_t stamp_ns;
  double tag;  // -1: no set-point
  bool new_run;
  bool operator==(const Outcome& other) const {
    return stamp_ns == other.stamp_ns && tag == other.tag && new_run == other.new_run;
  }
};

std::vector<Outcome> drain(TickJoiner& joiner) {
  std::vector<Outcome> outcomes;
  while (const auto tick = joiner.next()) {
    const double tag = tick->setpoint ? tick->setpoint->pose.hand_in_base.translation().x() : -1.0;
    outcomes.push_back({tick->joints.stamp_ns, tag, tick->new_run});
  }
  return outcomes;
}

TEST(TickJoiner, WaitsForTheSetpointOfTheSameStamp) {
  TickJoiner joiner(0.3);
  joiner.add_joints(tick_at(5 * kTick));
  EXPECT_TRUE(drain(joiner).empty());
  joiner.add_setpoint(5 * kTick, tagged(5.0));
  EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{5 * kTick, 5.0, false}}));
  EXPECT_TRUE(drain(joiner).empty());
}

TEST(TickJoiner, AnswersWithoutASetpointWhenALaterOneHasCome) {
  TickJoiner joiner(0.3);
  joiner.add_joints(tick_at(1 * kTick));
  joiner.add_setpoint(2 * kTick, tagged(2.0));
  EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{1 * kTick, -1.0, false}}));
  joiner.add_joints(tick_at(2 * kTick));
  EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{2 * kTick, 2.0, false}}));
  EXPECT_EQ(joiner.counts().missing_setpoints, 1u);
}

TEST(TickJoiner, GivesUpByDataTimeAndJoinsAgainWhenItSpeaks) {
  TickJoiner joiner(0.03);
  for (int i = 0; i <= 3; ++i) joiner.add_joints(tick_at(i * kTick));
  EXPECT_TRUE(drain(joiner).empty());
  joiner.add_joints(tick_at(4 * kTick));
  EXPECT_EQ(drain(joiner).size(), 5u);
  joiner.add_joints(tick_at(5 * kTick));
  EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{5 * kTick, -1.0, false}}));
  EXPECT_EQ(joiner.counts().silences, 1u);

  joiner.add_setpoint(5 * kTick, tagged(5.0));
  EXPECT_EQ(joiner.counts().late_setpoints, 1u);
  joiner.add_joints(tick_at(6 * kTick));
  EXPECT_TRUE(drain(joiner).empty());
  joiner.add_setpoint(6 * kTick, tagged(6.0));
  EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{6 * kTick, 6.0, false}}));
}

TEST(TickJoiner, IgnoresASecondTickOrSetpointOfOneStamp) {
  TickJoiner joiner(0.3);
  joiner.add_joints(tick_at(kTick));
  joiner.add_joints(tick_at(kTick));
  joiner.add_setpoint(2 * kTick, tagged(1.0));
  joiner.add_setpoint(2 * kTick, tagged(2.0));
  joiner.add_joints(tick_at(2 * kTick));
  EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{kTick, -1.0, false}, {2 * kTick, 1.0, false}}));
  EXPECT_EQ(joiner.counts().duplicate_ticks, 1u);
  EXPECT_EQ(joiner.counts().late_setpoints, 1u);
}

// Both topics in their own order, interleaved at random, neither more than max_wait behind.
std::vector<Outcome> run_interleaved(unsigned seed) {
  constexpr int kTicks = 500;
  std::mt19937 random(seed);
  TickJoiner joiner(0.3);
  std::vector<Outcome> outcomes;
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
    for (const Outcome& one : drain(joiner)) outcomes.push_back(one);
  }
  return outcomes;
}

TEST(TickJoiner, AnswersTheSameWhateverTheInterleaving) {
  const std::vector<Outcome> first = run_interleaved(0);
  ASSERT_EQ(first.size(), 500u);
  for (const Outcome& one : first) {
    const auto tick = one.stamp_ns / kTick;
    EXPECT_EQ(one.tag, tick % 7 == 0 ? -1.0 : static_cast<double>(tick));
  }
  for (unsigned seed = 1; seed < 200; ++seed) ASSERT_EQ(run_interleaved(seed), first) << seed;
}

// The order in which the two topics show that a new run has begun must not matter either.
TEST(TickJoiner, BeginsANewRunWhenTicksGoBackInTime) {
  for (const bool setpoint_first : {true, false}) {
    TickJoiner joiner(0.3);
    for (int i = 100; i < 110; ++i) {
      joiner.add_joints(tick_at(i * kTick));
      if (i < 109) joiner.add_setpoint(i * kTick, tagged(i));
    }
    EXPECT_EQ(drain(joiner).size(), 9u);
    if (setpoint_first) joiner.add_setpoint(0, tagged(0.5));
    joiner.add_joints(tick_at(0));
    if (!setpoint_first) joiner.add_setpoint(0, tagged(0.5));
    EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{0, 0.5, true}})) << setpoint_first;
    joiner.add_joints(tick_at(kTick));
    EXPECT_TRUE(drain(joiner).empty());
    joiner.add_setpoint(kTick, tagged(1.5));
    EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{kTick, 1.5, false}}));
    EXPECT_EQ(joiner.counts().new_runs, 1u);
  }
}

TEST(TickJoiner, ForgetsSetpointsOfTheLastRun) {
  TickJoiner joiner(0.3);
  joiner.add_joints(tick_at(3 * kTick));
  joiner.add_setpoint(4 * kTick, tagged(4.0));
  EXPECT_EQ(drain(joiner).size(), 1u);
  joiner.add_joints(tick_at(kTick));
  for (int i = 2; i <= 4; ++i) joiner.add_joints(tick_at(i * kTick));
  EXPECT_TRUE(drain(joiner).empty());
}

TEST(TickJoiner, RecoversFromASetpointStampedFarInTheFuture) {
  TickJoiner joiner(0.3);
  joiner.add_setpoint(1'000'000 * kTick, tagged(9.0));
  joiner.add_joints(tick_at(kTick));
  EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{kTick, -1.0, false}}));
  joiner.add_joints(tick_at(2 * kTick));
  joiner.add_setpoint(2 * kTick, tagged(2.0));
  drain(joiner);
  joiner.add_joints(tick_at(3 * kTick));
  joiner.add_setpoint(3 * kTick, tagged(3.0));
  EXPECT_EQ(drain(joiner), (std::vector<Outcome>{{3 * kTick, 3.0, false}}));
}

TEST(TickJoiner, RefusesAnImpossibleWait) {
  for (const double wait : {0.0, -1.0, std::nan(""), 11.0}) {
    EXPECT_THROW(TickJoiner{wait}, std::invalid_argument) << wait;
  }
}

}  // namespace
}  // namespace prf_control
