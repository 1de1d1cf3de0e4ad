// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/lockstep.hpp"

#include <gtest/gtest.h>

namespace platform_sim {
namespace {

constexpr prf_core::Stamp kMs = std::chrono::milliseconds(1);
constexpr prf_core::Stamp kNone{0};

void expect_silent(const Lockstep& lockstep, Response response, prf_core::Stamp stamp) {
  const std::optional<SilentTopic> silent = lockstep.first_silent();
  ASSERT_TRUE(silent);
  EXPECT_STREQ(topic_name(silent->response), topic_name(response));
  EXPECT_EQ(silent->stamp, stamp);
}

void respond_to_tick(Lockstep& lockstep, prf_core::Stamp tick, prf_core::Stamp forecast_stamp) {
  lockstep.received_progress(tick, forecast_stamp);
  lockstep.received(Response::kSetpoint, tick);
  lockstep.received(Response::kCommand, tick);
}

TEST(Lockstep, NeedsCommandAndProgressOfTheTick) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  EXPECT_FALSE(lockstep.is_complete());
  lockstep.received(Response::kCommand, 10 * kMs);
  EXPECT_FALSE(lockstep.is_complete());
  lockstep.received_progress(10 * kMs, kNone);
  EXPECT_TRUE(lockstep.is_complete());
}

TEST(Lockstep, NeedsAMessageToTheDriverWhereThereIsOne) {
  Lockstep lockstep(Peer::kFramework, true);
  lockstep.published_joint_states(10 * kMs);
  respond_to_tick(lockstep, 10 * kMs, kNone);
  EXPECT_FALSE(lockstep.is_complete());
  EXPECT_EQ(lockstep.received(Response::kDriver, 10 * kMs), Receipt::kTaken);
  EXPECT_TRUE(lockstep.is_complete());
}

TEST(Lockstep, DoesNotTakeAnOldResponseForTheTick) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  respond_to_tick(lockstep, 10 * kMs, kNone);
  lockstep.published_joint_states(20 * kMs);
  EXPECT_EQ(lockstep.received(Response::kCommand, 10 * kMs), Receipt::kNotNewer);
  EXPECT_EQ(lockstep.received_progress(10 * kMs, kNone), Receipt::kNotNewer);
  EXPECT_FALSE(lockstep.is_complete());
  respond_to_tick(lockstep, 20 * kMs, kNone);
  EXPECT_TRUE(lockstep.is_complete());
  EXPECT_FALSE(lockstep.first_silent());
}

// Fault 38, 50: a response that does not come -> the world goes on; it is waited for again once
// heard
TEST(Lockstep, GoesOnWithoutAGivenUpTopicUntilItIsHeardAgain) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  lockstep.received_progress(10 * kMs, kNone);
  EXPECT_EQ(lockstep.go_on(), std::vector<Response>{Response::kCommand});
  EXPECT_TRUE(lockstep.is_complete());
  EXPECT_TRUE(lockstep.goes_without());
  lockstep.published_joint_states(20 * kMs);
  EXPECT_FALSE(lockstep.is_complete()) << "progress is still waited for";
  lockstep.received_progress(20 * kMs, kNone);
  EXPECT_TRUE(lockstep.is_complete());
  lockstep.received(Response::kCommand, 20 * kMs);
  EXPECT_FALSE(lockstep.goes_without());
  lockstep.published_joint_states(30 * kMs);
  lockstep.received_progress(30 * kMs, kNone);
  EXPECT_FALSE(lockstep.is_complete()) << "the command is waited for again";
}

TEST(Lockstep, NamesEveryLinkOfTheChainWhenItAloneIsSilent) {
  for (const Response mute : {Response::kDetections, Response::kForecast, Response::kProgress,
                              Response::kTrajectory, Response::kSetpoint, Response::kCommand}) {
    Lockstep lockstep(Peer::kFramework);
    // Each response exists only if what it responds to exists.
    lockstep.published_image(10 * kMs);
    lockstep.published_joint_states(50 * kMs);
    respond_to_tick(lockstep, 50 * kMs, kNone);
    lockstep.published_joint_states(60 * kMs);
    prf_core::Stamp expected = 10 * kMs;
    const bool sees = mute != Response::kDetections;
    const bool predicts = sees && mute != Response::kForecast;
    if (sees) lockstep.received(Response::kDetections, 10 * kMs);
    if (predicts) {
      lockstep.received(Response::kForecast, 10 * kMs);
      expected = 60 * kMs;
      if (mute != Response::kProgress) {
        lockstep.received_progress(60 * kMs, 10 * kMs);
        if (mute != Response::kTrajectory) lockstep.received(Response::kTrajectory, 60 * kMs);
        if (mute != Response::kSetpoint) lockstep.received(Response::kSetpoint, 60 * kMs);
        if (mute == Response::kTrajectory) {  // the decision goes on for one tick, then waits
          lockstep.received(Response::kCommand, 60 * kMs);
          EXPECT_TRUE(lockstep.is_complete());
          lockstep.published_joint_states(70 * kMs);
        }
      }
    }
    EXPECT_FALSE(lockstep.is_complete());
    expect_silent(lockstep, mute, expected);
  }
}

TEST(Lockstep, AsksForATrajectoryOncePerForecast) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  respond_to_tick(lockstep, 10 * kMs, 5 * kMs);
  expect_silent(lockstep, Response::kTrajectory, 10 * kMs);
  lockstep.received(Response::kTrajectory, 10 * kMs);
  lockstep.published_joint_states(20 * kMs);
  respond_to_tick(lockstep, 20 * kMs, 5 * kMs);
  EXPECT_FALSE(lockstep.first_silent());
}

TEST(Lockstep, AcceptsAResponseThatArrivesBeforeItIsExpected) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_image(10 * kMs);
  lockstep.published_joint_states(50 * kMs);
  lockstep.received(Response::kForecast, 10 * kMs);
  lockstep.received(Response::kDetections, 10 * kMs);
  lockstep.received(Response::kTrajectory, 50 * kMs);
  lockstep.received_progress(50 * kMs, 10 * kMs);
  lockstep.received(Response::kSetpoint, 50 * kMs);
  lockstep.received(Response::kCommand, 50 * kMs);
  EXPECT_FALSE(lockstep.first_silent());
}

// Fault 10, 51: any response stamped far ahead -> dropped; the ones after it count as before
TEST(Lockstep, IsNotWedgedByAResponseToWhatWasNeverPublished) {
  Lockstep framework(Peer::kFramework);
  Lockstep guide(Peer::kGuide);
  for (Lockstep* lockstep : {&framework, &guide}) {
    EXPECT_EQ(lockstep->received(Response::kCommand, 10 * kMs), Receipt::kAhead) << "nothing yet";
    lockstep->published_image(5 * kMs);
    lockstep->published_joint_states(10 * kMs);
    for (const prf_core::Stamp wrong : {11 * kMs, 1010 * kMs, prf_core::Stamp::max()}) {
      for (const Response response :
           {Response::kDetections, Response::kForecast, Response::kTrajectory, Response::kSetpoint,
            Response::kCommand, Response::kWrench}) {
        EXPECT_EQ(lockstep->received(response, wrong), Receipt::kAhead);
      }
      EXPECT_EQ(lockstep->received_progress(wrong, kNone), Receipt::kAhead);
    }
    EXPECT_FALSE(lockstep->is_complete());
  }
  EXPECT_EQ(framework.received(Response::kDetections, 5 * kMs), Receipt::kTaken);
  EXPECT_EQ(framework.received(Response::kForecast, 5 * kMs), Receipt::kTaken);
  respond_to_tick(framework, 10 * kMs, kNone);
  EXPECT_FALSE(framework.first_silent());
  EXPECT_EQ(guide.received(Response::kWrench, 10 * kMs), Receipt::kTaken);
  EXPECT_TRUE(guide.is_complete());
}

// Fault 42, 51: progress names a forecast of the far future -> no trajectory of it is waited for
TEST(Lockstep, AsksForNoTrajectoryOfAForecastThatCannotBe) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  respond_to_tick(lockstep, 10 * kMs, prf_core::Stamp::max());
  EXPECT_FALSE(lockstep.first_silent());
}

// Fault 11, 26: ticks without response at the start or from a killed node -> waited for again later
TEST(Lockstep, WaitsAgainForWhatItGaveUp) {
  Lockstep lockstep(Peer::kFramework);
  lockstep.published_joint_states(10 * kMs);
  EXPECT_EQ(lockstep.go_on(), (std::vector{Response::kProgress, Response::kCommand}));
  EXPECT_TRUE(lockstep.is_complete());
  lockstep.published_joint_states(20 * kMs);
  EXPECT_TRUE(lockstep.is_complete() && lockstep.goes_without());
  lockstep.received_progress(20 * kMs, kNone);
  lockstep.published_joint_states(30 * kMs);
  EXPECT_FALSE(lockstep.is_complete()) << "progress is heard again";
  lockstep.received_progress(30 * kMs, kNone);
  EXPECT_TRUE(lockstep.is_complete());
  lockstep.insist();
  EXPECT_FALSE(lockstep.is_complete() || lockstep.goes_without());
  lockstep.received(Response::kCommand, 30 * kMs);
  EXPECT_TRUE(lockstep.is_complete());
}

TEST(Lockstep, NamesTheOldestImageWithoutResponse) {
  Lockstep lockstep(Peer::kFramework);
  for (const prf_core::Stamp stamp : {10 * kMs, 43 * kMs, 77 * kMs})
    lockstep.published_image(stamp);
  lockstep.received(Response::kDetections, 10 * kMs);
  lockstep.received(Response::kForecast, 10 * kMs);
  expect_silent(lockstep, Response::kDetections, 43 * kMs);
}

TEST(Lockstep, AsksOnlyTheGuideWhileAHandGuidesTheArm) {
  Lockstep lockstep(Peer::kGuide);
  lockstep.published_image(10 * kMs);
  lockstep.received(Response::kDetections, 10 * kMs);
  lockstep.published_joint_states(50 * kMs);
  expect_silent(lockstep, Response::kWrench, 50 * kMs);
  respond_to_tick(lockstep, 50 * kMs, 10 * kMs);
  EXPECT_FALSE(lockstep.is_complete());
  lockstep.received(Response::kWrench, 50 * kMs);
  EXPECT_TRUE(lockstep.is_complete());
  EXPECT_FALSE(lockstep.first_silent());
}

}  // namespace
}  // namespace platform_sim
