// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/frame_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace prf_predictor {
namespace {

using Effect = FrameChain::Effect;
using Readiness = FrameChain::Readiness;
using prf_core::Duration;
using prf_core::Stamp;

constexpr Duration kTick = std::chrono::milliseconds(10);
constexpr Stamp kStart = std::chrono::seconds(100);

FrameChain::Transform link(const std::string& parent, const std::string& child, Stamp stamp,
                           double x = 0.0) {
  return {parent, child, stamp, {{x, 0, 0}, Eigen::Quaterniond::Identity()}};
}

// base -> shoulder (moving) -> camera (fixed), and the planning frame on base. The shoulder moves
// with 1 m/s along x.
FrameChain robot() {
  FrameChain chain("planning", std::chrono::milliseconds(500));
  chain.add(link("base", "planning", Stamp{0}, 1.0), true);
  chain.add(link("shoulder", "camera", Stamp{0}, 0.5), true);
  return chain;
}

Effect move(FrameChain& chain, Stamp stamp) {
  return chain.add(link("base", "shoulder", stamp, prf_core::to_seconds(stamp - kStart)), false);
}

double camera_x(const FrameChain& chain, Stamp stamp) {
  const auto found = chain.lookup("camera", stamp);
  EXPECT_EQ(found.readiness, Readiness::kReady) << found.reason;
  return found.camera_in_planning.translation().x();
}

TEST(FrameChain, InterpolatesOnceALaterSampleIsThere) {
  auto chain = robot();
  move(chain, kStart);
  move(chain, kStart + kTick);
  EXPECT_NEAR(camera_x(chain, kStart + kTick / 2), 0.005 + 0.5 - 1.0, 1e-12);
  EXPECT_EQ(chain.lookup("camera", kStart + kTick).readiness, Readiness::kWait);
  move(chain, kStart + 2 * kTick);
  EXPECT_NEAR(camera_x(chain, kStart + kTick), 0.01 + 0.5 - 1.0, 1e-12);
}

// Fault 5: camera clock ahead of the robot's, or behind -> the reason says by how much, and asks
TEST(FrameChain, SaysByHowMuchTheClocksDiffer) {
  auto chain = robot();
  EXPECT_EQ(chain.lookup("camera", kStart).reason, "\"camera\" is not connected to planning");
  move(chain, kStart);
  move(chain, kStart + kTick);
  const auto ahead = chain.lookup("camera", kStart + std::chrono::seconds(5));
  EXPECT_EQ(ahead.readiness, Readiness::kWait);
  EXPECT_EQ(ahead.reason,
            "the image's stamp is 4.99 s ahead of the newest tf from \"base\": are the clocks of "
            "camera and robot synchronised?");
  EXPECT_EQ(chain.lookup("camera", kStart + 2 * kTick).reason,
            "the image's stamp is 0.01 s ahead of the newest tf from \"base\"");
  EXPECT_EQ(chain.lookup("camera", kStart - std::chrono::seconds(3)).reason,
            "no transform between planning and \"camera\" at the stamp of the image, which is 3 s "
            "before the oldest tf from \"base\": are the clocks of camera and robot synchronised?");
}

TEST(FrameChain, ComposesRotationsOnBothSides) {
  FrameChain chain("planning", std::chrono::milliseconds(500));
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  chain.add({"root", "planning", Stamp{0}, {{0, 1, 0}, quarter}}, true);
  chain.add({"root", "arm", Stamp{0}, {{2, 0, 0}, quarter}}, true);
  chain.add({"arm", "camera", Stamp{0}, {{0, 3, 0}, Eigen::Quaterniond::Identity()}}, true);
  const auto found = chain.lookup("camera", kStart);
  ASSERT_EQ(found.readiness, Readiness::kReady) << "nothing moves";
  // camera at (2 - 3, 0, 0) of root, seen from (0, 1, 0) turned by 90 degrees.
  EXPECT_LT((found.camera_in_planning.translation() - Eigen::Vector3d(-1, 1, 0)).norm(), 1e-12);
  EXPECT_LT((found.camera_in_planning.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

// Fault 41: tf of unrelated frames with any stamp -> ignored, the camera's chain is as without
TEST(FrameChain, IgnoresUnrelatedFramesWhateverTheirStamps) {
  auto chain = robot();
  const double nan = std::nan("");
  for (int k = 0; k < 300; ++k) {
    const Stamp now = kStart + k * kTick;
    move(chain, now);
    for (const Duration off : {Duration{-1500}, Duration{2000}, Duration{86400000}}) {
      chain.add(link("map", "odom", now + 1000 * 1000 * off), false);
      chain.add(link("shoulder", "lamp", now + 1000 * 1000 * off), false);
    }
    chain.add(link("map", "odom", Stamp{0}), false);
    chain.add(link("map", "nan", now, nan), false);
    if (k < 2) continue;
    ASSERT_NEAR(camera_x(chain, now - kTick / 2),
                prf_core::to_seconds(now - kTick / 2 - kStart) - 0.5, 1e-9);
    ASSERT_EQ(chain.lookup("camera", now).readiness, Readiness::kWait) << "as without them";
    ASSERT_EQ(chain.lookup("unknown", now + kTick).readiness, Readiness::kWait);
  }
  EXPECT_FALSE(chain.is_between("odom", "camera"));
  EXPECT_FALSE(chain.is_between("lamp", "camera"));
  EXPECT_TRUE(chain.is_between("shoulder", "camera"));
  EXPECT_TRUE(chain.is_between("planning", "camera"));
}

// Fault 40: one late, early or doubled tf of the camera's chain -> dropped, the rest goes on
TEST(FrameChain, DropsSingleWrongStampsOfTheChain) {
  auto chain = robot();
  for (int k = 0; k < 20; ++k) move(chain, kStart + k * kTick);
  EXPECT_EQ(move(chain, kStart + 19 * kTick), Effect::kDuplicate);
  EXPECT_EQ(move(chain, kStart + 10 * kTick), Effect::kOld);
  EXPECT_EQ(move(chain, kStart - std::chrono::seconds(50)), Effect::kOld);
  EXPECT_EQ(move(chain, Stamp{0}), Effect::kOld);
  EXPECT_EQ(move(chain, kStart + std::chrono::seconds(50)), Effect::kFarAhead);
  EXPECT_EQ(move(chain, kStart + 20 * kTick), Effect::kStored);
  EXPECT_NEAR(camera_x(chain, kStart + 19 * kTick + kTick / 2), 0.195 - 0.5, 1e-12);
  EXPECT_EQ(chain.lookup("camera", kStart + 20 * kTick).readiness, Readiness::kWait);
}

// Fault 11: the clock of the camera's chain goes back -> three samples prove it, old tf is gone
TEST(FrameChain, FollowsAClockThatWentBackOrLeapt) {
  for (const Duration leap :
       {Duration(std::chrono::seconds(-50)), Duration(std::chrono::seconds(50))}) {
    auto chain = robot();
    for (int k = 0; k < 20; ++k) move(chain, kStart + k * kTick);
    EXPECT_NE(move(chain, kStart + leap), Effect::kStored);
    EXPECT_NE(move(chain, kStart + leap + kTick), Effect::kStored);
    EXPECT_EQ(move(chain, kStart + leap + 2 * kTick), Effect::kStored);
    move(chain, kStart + leap + 3 * kTick);
    EXPECT_NEAR(camera_x(chain, kStart + leap + 2 * kTick + kTick / 2),
                prf_core::to_seconds(leap) + 0.025 - 0.5, 1e-9);
    EXPECT_EQ(chain.lookup("camera", kStart + leap + kTick / 2).readiness, Readiness::kNever);
  }
}

TEST(FrameChain, DropsTfOfTheOldRunWhenTheImagesBeginANewOne) {
  auto chain = robot();
  move(chain, kStart);
  chain.begin_run(kStart - std::chrono::seconds(50));
  EXPECT_EQ(move(chain, kStart - std::chrono::seconds(50)), Effect::kStored);
  EXPECT_EQ(chain.lookup("camera", kStart - std::chrono::seconds(50)).readiness, Readiness::kWait);
}

// Fault 5: tf comes later than its image -> the image waits, within a bound; then it is decided
TEST(FrameChain, WaitsForTfWithinABound) {
  auto chain = robot();
  EXPECT_EQ(chain.lookup("camera", kStart).readiness, Readiness::kWait);
  move(chain, kStart);
  move(chain, kStart + kTick);
  EXPECT_EQ(chain.lookup("camera", kStart + 2 * kTick).readiness, Readiness::kWait);
  EXPECT_EQ(chain.lookup("camera", kStart - kTick).readiness, Readiness::kNever);
}

// Fault 4: an image in an unknown frame -> never to be had once tf has gone on; no crash
TEST(FrameChain, HasNoPoseOfAnUnknownFrame) {
  auto chain = robot();
  EXPECT_EQ(chain.lookup("nowhere", kStart).readiness, Readiness::kWait);
  move(chain, kStart + kTick);
  EXPECT_EQ(chain.lookup("nowhere", kStart).readiness, Readiness::kNever);
  EXPECT_EQ(chain.lookup("", kStart).readiness, Readiness::kNever);
}

// Fault 43: tf with NaN, absurd numbers, a zero quaternion or a loop of frames -> refused
TEST(FrameChain, RefusesWhatIsNoTransform) {
  auto chain = robot();
  move(chain, kStart);
  auto bad = link("base", "shoulder", kStart + kTick, 1e300);
  EXPECT_EQ(chain.add(bad, false), Effect::kBadPose);
  bad.pose.position.x() = std::nan("");
  EXPECT_EQ(chain.add(bad, false), Effect::kBadPose);
  bad.pose = {{0, 0, 0}, Eigen::Quaterniond(0, 0, 0, 0)};
  EXPECT_EQ(chain.add(bad, false), Effect::kBadPose);
  EXPECT_EQ(chain.add(link("", "shoulder", kStart), false), Effect::kBadFrames);
  EXPECT_EQ(chain.add(link("base", "", kStart), false), Effect::kBadFrames);
  EXPECT_EQ(chain.add(link("a", "a", kStart), false), Effect::kBadFrames);
  chain.add(link("b", "a", kStart), false);
  chain.add(link("a", "b", kStart), false);
  EXPECT_EQ(chain.lookup("a", kStart).readiness, Readiness::kWait);
  move(chain, kStart + kTick);
  EXPECT_NEAR(camera_x(chain, kStart), -0.5, 1e-12);
}

// Fault 19: another node gives a frame of the camera's chain another parent -> it keeps its own
TEST(FrameChain, KeepsTheParentOfAFrameAgainstASecondPublisher) {
  auto chain = robot();
  for (int k = 0; k < 20; ++k) {
    move(chain, kStart + k * kTick);
    EXPECT_EQ(chain.add(link("map", "shoulder", kStart + k * kTick + kTick / 2), false),
              Effect::kOtherParent);
    if (k < 2) continue;
    EXPECT_EQ(chain.lookup("camera", kStart + k * kTick - kTick / 2).readiness, Readiness::kReady);
  }
  for (int k = 20; k < 23; ++k) chain.add(link("planning", "shoulder", kStart + k * kTick), false);
  chain.add(link("planning", "shoulder", kStart + 23 * kTick), false);
  EXPECT_NEAR(camera_x(chain, kStart + 22 * kTick + kTick / 2), 0.5, 1e-12) << "it was moved over";
}

TEST(FrameChain, KeepsAFrameCountWithinABound) {
  auto chain = robot();
  Effect effect = Effect::kStored;
  for (std::size_t k = 0; k < FrameChain::kMostFrames; ++k) {
    effect = chain.add(link("map", "f" + std::to_string(k), kStart), false);
  }
  EXPECT_EQ(effect, Effect::kTooMany);
  EXPECT_EQ(move(chain, kStart), Effect::kTooMany);
}

}  // namespace
}  // namespace prf_predictor
