// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/lockstep.hpp"

#include <gtest/gtest.h>

namespace platform_sim {
namespace {

constexpr StampNs kMs = 1'000'000;

void expect_silent(const Lockstep& lockstep, Link link, StampNs stamp) {
  const std::optional<SilentTopic> silent = lockstep.first_silent();
  ASSERT_TRUE(silent);
  EXPECT_STREQ(topic_name(silent->link), topic_name(link));
  EXPECT_EQ(silent->stamp, stamp);
}

void answer_tick(Lockstep& lockstep, StampNs tick, StampNs forecast_stamp) {
  lockstep.received_progress(tick, forecast_stamp);
  lockstep.received(Link::kSetpoint, tick);
  lockstep.received(Link::kCommand, tick);
}

TEST(Lockstep, NeedsCommandAndProgressOfTheTick) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  EXPECT_FALSE(lockstep.answered());
  lockstep.received(Link::kCommand, 10 * kMs);
  EXPECT_FALSE(lockstep.answered());
  lockstep.received_progress(10 * kMs, 0);
  EXPECT_TRUE(lockstep.answered());
}

TEST(Lockstep, DoesNotTakeAnOldAnswerForTheTick) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  answer_tick(lockstep, 10 * kMs, 0);
  lockstep.published_joint_states(20 * kMs);
  EXPECT_FALSE(lockstep.received(Link::kCommand, 10 * kMs));
  EXPECT_FALSE(lockstep.received_progress(10 * kMs, 0));
  EXPECT_FALSE(lockstep.answered());
  answer_tick(lockstep, 20 * kMs, 0);
  EXPECT_TRUE(lockstep.answered());
  EXPECT_FALSE(lockstep.first_silent());
}

TEST(Lockstep, NamesEveryLinkOfTheChainWhenItAloneIsSilent) {
  for (const Link mute : {Link::kDetections, Link::kForecast, Link::kProgress, Link::kTrajectory,
                          Link::kSetpoint, Link::kCommand}) {
    Lockstep lockstep(Peer::kFramework);
    // Each answer exists only if what it answers exists.
    lockstep.published_image(10 * kMs);
    lockstep.published_joint_states(50 * kMs);
    answer_tick(lockstep, 50 * kMs, 0);
    lockstep.published_joint_states(60 * kMs);
    StampNs expected = 10 * kMs;
    const bool sees = mute != Link::kDetections;
    const bool predicts = sees && mute != Link::kForecast;
    if (sees) lockstep.received(Link::kDetections, 10 * kMs);
    if (predicts) {
      lockstep.received(Link::kForecast, 10 * kMs);
      expected = 60 * kMs;
      if (mute != Link::kProgress) {
        lockstep.received_progress(60 * kMs, 10 * kMs);
        if (mute != Link::kTrajectory) lockstep.received(Link::kTrajectory, 60 * kMs);
        if (mute != Link::kSetpoint) lockstep.received(Link::kSetpoint, 60 * kMs);
        if (mute == Link::kTrajectory) {  // the decision goes on for one tick, then waits
          lockstep.received(Link::kCommand, 60 * kMs);
          EXPECT_TRUE(lockstep.answered());
          lockstep.published_joint_states(70 * kMs);
        }
      }
    }
    EXPECT_FALSE(lockstep.answered());
    expect_silent(lockstep, mute, expected);
  }
}

TEST(Lockstep, AsksForATrajectoryOncePerForecast) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  answer_tick(lockstep, 10 * kMs, 5 * kMs);
  expect_silent(lockstep, Link::kTrajectory, 10 * kMs);
  lockstep.received(Link::kTrajectory, 10 * kMs);
  lockstep.published_joint_states(20 * kMs);
  answer_tick(lockstep, 20 * kMs, 5 * kMs);
  EXPECT_FALSE(lockstep.first_silent());
}

TEST(Lockstep, AcceptsAnAnswerThatArrivesBeforeItsQuestion) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.received(Link::kForecast, 10 * kMs);
  lockstep.received(Link::kDetections, 10 * kMs);
  lockstep.received(Link::kTrajectory, 50 * kMs);
  lockstep.received_progress(50 * kMs, 10 * kMs);
  EXPECT_FALSE(lockstep.first_silent());
}

TEST(Lockstep, NamesTheOldestImageThatWasNotAnswered) {
  Lockstep lockstep(Peer::kFramework);
  for (const StampNs stamp : {10 * kMs, 43 * kMs, 77 * kMs}) lockstep.published_image(stamp);
  lockstep.received(Link::kDetections, 10 * kMs);
  lockstep.received(Link::kForecast, 10 * kMs);
  expect_silent(lockstep, Link::kDetections, 43 * kMs);
}

TEST(Lockstep, AsksOnlyTheGuideWhileAHandGuidesTheArm) {
  Lockstep lockstep(Peer::kGuide);
  lockstep.published_image(10 * kMs);
  lockstep.received(Link::kDetections, 10 * kMs);
  lockstep.published_joint_states(50 * kMs);
  expect_silent(lockstep, Link::kWrench, 50 * kMs);
  answer_tick(lockstep, 50 * kMs, 10 * kMs);
  EXPECT_FALSE(lockstep.answered());
  lockstep.received(Link::kWrench, 50 * kMs);
  EXPECT_TRUE(lockstep.answered());
  EXPECT_FALSE(lockstep.first_silent());
}

}  // namespace
}  // namespace platform_sim
