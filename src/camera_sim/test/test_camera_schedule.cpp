// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/camera_schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace camera_sim {
namespace {

std::vector<Frame> frames_until(CameraSchedule& schedule, std::int64_t end_ms,
                                std::vector<std::int64_t>* instants = nullptr) {
  std::vector<Frame> frames;
  for (std::int64_t now = 1; now <= end_ms; ++now) {
    if (!schedule.captures_at(now)) continue;
    if (instants) instants->push_back(now);
    schedule.capture(now, CameraView{});
    while (std::optional<Frame> frame = schedule.take_exposed()) frames.push_back(*frame);
  }
  return frames;
}

TEST(CameraSchedule, TakesThirtyFramesASecondWithoutDrift) {
  CameraSchedule schedule({0.04, 0.0}, 10);
  const std::vector<Frame> frames = frames_until(schedule, 60'009);
  ASSERT_EQ(frames.size(), 1800U);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].index, k);
    EXPECT_LE(std::abs(static_cast<double>(frames[k].stamp_ms) - 10.0 -
                       static_cast<double>(k) * 1000.0 / 30.0),
              0.5);
  }
}

TEST(CameraSchedule, SpreadsInstantsSymmetricallyOverTheExposure) {
  for (int exposure_ms = 0; exposure_ms <= 16; ++exposure_ms) {
    CameraSchedule schedule({0.04, 1e-3 * exposure_ms}, 10);
    std::vector<std::int64_t> instants;
    const std::vector<Frame> frames = frames_until(schedule, 30, &instants);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(static_cast<int>(instants.size()), std::max(1, (exposure_ms + 2) / 3));
    std::int64_t sum = 0;
    for (const std::int64_t instant : instants) {
      sum += instant - 10;
      EXPECT_LE(std::abs(2 * (instant - 10)), exposure_ms);
    }
    EXPECT_EQ(sum, 0) << exposure_ms;
  }
}

TEST(CameraSchedule, PublishesNotBeforeTheLatencyHasPassed) {
  const CameraSchedule schedule({0.04, 0.006}, 10);
  Frame frame;
  frame.stamp_ms = 43;
  EXPECT_FALSE(schedule.is_due(frame, 80));
  EXPECT_TRUE(schedule.is_due(frame, 83));
  EXPECT_TRUE(schedule.is_due(frame, 90));
}

TEST(CameraSchedule, RefusesABadTimingOrInstant) {
  EXPECT_THROW(CameraSchedule({-0.01, 0.0}, 10), std::invalid_argument);
  EXPECT_THROW(CameraSchedule({0.6, 0.0}, 10), std::invalid_argument);
  EXPECT_THROW(CameraSchedule({0.04, 0.017}, 10), std::invalid_argument);
  EXPECT_THROW(CameraSchedule({std::nan(""), 0.0}, 10), std::invalid_argument);
  CameraSchedule schedule({0.04, 0.0}, 10);
  EXPECT_THROW(schedule.capture(11, CameraView{}), std::invalid_argument);
}

}  // namespace
}  // namespace camera_sim
