// SPDX-License-Identifier: BSD-3-Clause
// A target that is out of sight is searched from the start of the skill, found again where it went
// to, and given up after a time.
#include <gtest/gtest.h>

#include "executive_world.hpp"

namespace prf_decision {
namespace {

constexpr double kView = 0.35;  // rad off the camera's axis, that it sees

DecisionParams searching_params() {
  DecisionParams params = usual_params();
  params.search = {from_seconds(8), 0.4, 1.2, jaco()};
  params.time_limit = from_seconds(60);
  params.reference.view_angle = 0.05;
  return params;
}

// The camera looks along the hand's x axis.
bool sees(const Pose& hand, const Eigen::Vector3d& target) {
  const Eigen::Vector3d sight = (target - hand.position).normalized();
  return (hand.orientation * Eigen::Vector3d::UnitX()).dot(sight) > std::cos(kView);
}

// A world whose target is seen only where the camera looks. Out of sight, the forecast stays where
// it was.
struct Hiding {
  Hiding() : world(searching_params()) { world.checks_steps = false; }

  ExecutiveResult tick() {
    const bool seen = !hidden && sees(world.hand, target);
    if (seen) world.position = target;
    world.status = seen ? TargetStatus::kTracking : TargetStatus::kLost;
    ExecutiveResult result = world.tick();
    if (result.progress.state == ExecutionState::kSearch) {
      nearest = std::min(nearest, (world.hand.position - world.position).norm());
    }
    return result;
  }

  ExecutiveResult until(ExecutionState state, double seconds) {
    ExecutiveResult result = tick();
    for (int k = 0; result.progress.state != state && k < 100 * seconds; ++k) result = tick();
    EXPECT_STREQ(name(result.progress.state), name(state)) << result.progress.reason;
    return result;
  }

  World world;
  Eigen::Vector3d target = kTarget;
  bool hidden = false;
  double nearest = 10;  // that the hand came to where the target was last, while it searched
};

// Fault 17: target covered and moved out of view meanwhile -> is searched from the start, found,
// and the skill is executed
TEST(SkillSearch, FindsATargetThatMovedWhileItWasHidden) {
  Hiding hiding;
  hiding.until(ExecutionState::kForward, 1);
  hiding.hidden = true;
  hiding.target = kTarget + Eigen::Vector3d(-0.1, 0.35, 0.1);
  const auto searching = hiding.until(ExecutionState::kSearch, 5);
  EXPECT_EQ(searching.progress.cause, Event::kMissing);
  EXPECT_EQ(searching.progress.cursor, 0);
  hiding.hidden = false;
  const auto back = hiding.until(ExecutionState::kReverse, 8);
  EXPECT_EQ(back.progress.cause, Event::kClear);
  hiding.until(ExecutionState::kForward, 5);
  EXPECT_EQ(hiding.world.position, hiding.target);
  EXPECT_GT(hiding.nearest, 0.65);  // at the start it is 0.7 m away
}

// Fault 17: target gone for good -> searched for search[0], then the execution ends as lost
TEST(SkillSearch, GivesUpAfterItsTimeAndSearchesAnewForTheNextGoal) {
  Hiding hiding;
  hiding.until(ExecutionState::kForward, 1);
  hiding.hidden = true;
  hiding.until(ExecutionState::kSearch, 5);
  int ticks = 0;
  auto result = hiding.tick();
  EXPECT_NE(result.progress.reason.find("looks"), std::string::npos) << result.progress.reason;
  for (; result.progress.state == ExecutionState::kSearch && ticks < 2000; ++ticks) {
    result = hiding.tick();
  }
  EXPECT_NEAR(ticks * to_seconds(kTickPeriod), 8, 0.1);
  EXPECT_EQ(result.progress.state, ExecutionState::kStopped);
  EXPECT_EQ(result.progress.cause, Event::kLost);
  EXPECT_EQ(result.progress.reason, "target not found within 8.00 s");
  hiding.world.executive().begin(SkillGoal());
  hiding.until(ExecutionState::kSearch, 1);
  for (ticks = 0; hiding.tick().progress.state == ExecutionState::kSearch && ticks < 2000;) ++ticks;
  EXPECT_NEAR(ticks * to_seconds(kTickPeriod), 8, 0.1);
}

TEST(SkillSearch, StandsStillWhereThePredictorIsSilentOrTheSkillIsAdaptedOnce) {
  Hiding silent;
  silent.until(ExecutionState::kForward, 1);
  silent.world.forecast_silent = true;
  for (int k = 0; k < 400; ++k) {
    EXPECT_NE(silent.tick().progress.state, ExecutionState::kSearch);
  }
  DecisionParams once = searching_params();
  once.reference.adaptation = Adaptation::kOnce;
  World world(once);
  world.until(ExecutionState::kForward, 1);
  world.status = TargetStatus::kLost;
  world.until(ExecutionState::kDone, 20);
  world.executive().begin(SkillGoal());  // begins at the start, with a target that is out of sight
  for (int k = 0; k < 600; ++k) EXPECT_NE(world.tick().progress.state, ExecutionState::kSearch);
}

TEST(SkillSearch, EndsByTheClientsWishAndTheTimeLimit) {
  Hiding hiding;
  hiding.until(ExecutionState::kForward, 1);
  hiding.hidden = true;
  hiding.until(ExecutionState::kSearch, 5);
  hiding.world.executive().preempt();
  const auto result = hiding.tick();
  EXPECT_EQ(result.progress.state, ExecutionState::kStopped);
  EXPECT_EQ(result.progress.cause, Event::kPreempted);
}

// The hand that does not follow is not driven on: the set-point begins again where it is.
TEST(SkillSearch, GoesOnFromWhereAHandThatDoesNotFollowIs) {
  Hiding hiding;
  hiding.until(ExecutionState::kForward, 1);
  hiding.hidden = true;
  hiding.until(ExecutionState::kSearch, 5);
  hiding.world.arm_follows = false;
  double farthest = 0;
  ExecutiveResult result;
  for (int k = 0; k < 1200; ++k) {
    result = hiding.tick();
    if (!result.setpoint) continue;
    farthest = std::max(
        farthest, result.setpoint->pose.orientation.angularDistance(hiding.world.hand.orientation));
  }
  EXPECT_LT(farthest, 0.37);
  EXPECT_EQ(result.progress.state, ExecutionState::kStopped);
}

}  // namespace
}  // namespace prf_decision
