// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/hand_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace camera_sim {
namespace {

std::string robot_urdf() {
  std::ifstream file(ROBOT_URDF_FILE);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A ball of 20 mm before the lens of a camera on a hand, and one on the link before the hand.
constexpr char kHand[] = R"(<robot name="r">
  <link name="arm"><visual><origin xyz="0 0 0.2"/>
    <geometry><sphere radius="0.05"/></geometry></visual></link>
  <joint name="wrist" type="continuous"><parent link="arm"/><child link="hand"/></joint>
  <link name="hand"/>
  <joint name="finger" type="fixed"><parent link="hand"/><child link="tip"/>
    <origin xyz="0.05 0 0.2"/></joint>
  <link name="tip"><visual><geometry><sphere radius="0.02"/></geometry></visual></link>
  <joint name="mount" type="fixed"><parent link="hand"/><child link="camera_optical_frame"/></joint>
  <link name="camera_optical_frame"/>
</robot>)";

Frame frame_at(std::int64_t stamp_ms) {
  Frame frame;
  frame.stamp_ms = stamp_ms;
  frame.views.resize(1);
  frame.views[0].camera.linear() = (Eigen::AngleAxisd(-M_PI_2, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(-M_PI_2, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  frame.views[0].camera.translation() = Eigen::Vector3d(0.3, 0.0, 1.3);
  return frame;
}

TEST(HandCamera, SeesTheHandBeforeTheSceneButNotTheArm) {
  for (const double k1 : {0.0, -0.3}) {
    HandCameraParams config;
    config.optics.distortion = {k1, k1 < 0.0 ? 0.1 : 0.0, 0.0, 0.0, 0.0};
    const HandCamera camera(kHand, TargetBox{}, config);
    const cv::Mat with_hand = camera.image(frame_at(0));
    const cv::Mat without =
        CameraRenderer(config.optics, TargetBox{}).render(frame_at(0).views.front());
    cv::Mat difference;
    cv::absdiff(with_hand, without, difference);
    const cv::Moments spot = cv::moments(difference > 0, true);
    const Eigen::Vector2d expected = config.optics.to_pixel({0.25, 0.0});
    EXPECT_NEAR(spot.m10 / spot.m00, expected.x(), 3.0) << "k1 " << k1;
    EXPECT_NEAR(spot.m01 / spot.m00, expected.y(), 1.0);
    const double radius = 615.0 * 0.1 * (1.0 + k1 * 0.0625);
    EXPECT_NEAR(spot.m00, M_PI * radius * radius, 0.15 * M_PI * radius * radius);
  }
}

TEST(HandCamera, LeavesTheTagInSightOfTheRealHand) {
  const HandCamera camera(robot_urdf(), TargetBox{}, {});
  cv::Mat difference;
  cv::absdiff(camera.image(frame_at(0)),
              CameraRenderer(PinholeCamera{}, TargetBox{}).render(frame_at(0).views.front()),
              difference);
  const int hand = cv::countNonZero(difference);
  EXPECT_GT(hand, 100);
  EXPECT_LT(hand, 0.2 * 640 * 480);
  const cv::Rect middle(160, 60, 320, 300);
  EXPECT_EQ(cv::countNonZero(difference(middle)), 0);
}

TEST(HandCamera, GetsBrighterAndDarkerWithTheLight) {
  HandCameraParams config;
  config.light_change = 0.5;
  config.light_period = 4.0;
  config.seed = 3;
  const HandCamera camera(kHand, TargetBox{}, config);
  const HandCamera steady(kHand, TargetBox{}, {});
  const double mean = cv::mean(steady.image(frame_at(0)))[0];
  double lowest = 9.0, highest = 0.0;
  int compared = 0;
  for (int ms = 0; ms < 4000; ms += 100) {
    const double gain = camera.gain(1e-3 * ms);
    lowest = std::min(lowest, gain);
    highest = std::max(highest, gain);
    if (gain < 1.1) {  // nothing saturates
      EXPECT_NEAR(cv::mean(camera.image(frame_at(ms)))[0], gain * mean, 1.5);
      ++compared;
    }
  }
  EXPECT_GE(compared, 20);  // of 40: more than half of a period is darker than 1.1
  EXPECT_NEAR(lowest, 0.5, 0.01);
  EXPECT_NEAR(highest, 1.5, 0.01);
}

TEST(HandCamera, HangsPostersFromTheSeed) {
  const auto image = [](int clutter, std::uint64_t seed) {
    HandCameraParams config;
    config.clutter = clutter;
    config.seed = seed;
    return HandCamera(kHand, TargetBox{}, config).image(frame_at(0));
  };
  EXPECT_GT(cv::countNonZero(image(0, 1) != image(40, 1)), 5000);
  EXPECT_GT(cv::countNonZero(image(40, 2) != image(40, 1)), 5000);
  EXPECT_EQ(cv::countNonZero(image(40, 1) != image(40, 1)), 0);
}

TEST(HandCamera, RefusesNonsense) {
  const std::vector<std::function<void(HandCameraParams&)>> faults{
      [](auto& config) { config.noise = -1.0; },
      [](auto& config) { config.light_change = 1.0; },
      [](auto& config) { config.light_period = 0.0; },
      [](auto& config) { config.clutter = -1; },
      [](auto& config) { config.optics.distortion[0] = -9.0; },
      [](auto& config) { config.timing.latency = -1.0; },
  };
  for (const auto& fault : faults) {
    HandCameraParams config;
    fault(config);
    EXPECT_THROW(HandCamera(kHand, TargetBox{}, config), std::invalid_argument);
  }
  EXPECT_THROW(HandCamera("<robot name='r'><link name='a'/></robot>", TargetBox{}, {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace camera_sim
