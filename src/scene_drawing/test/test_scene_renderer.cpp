// SPDX-License-Identifier: BSD-3-Clause
#include "scene_drawing/scene_renderer.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace scene_drawing {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// A red ball at the end of a bar that turns about z.
constexpr char kRobot[] = R"(<robot name="r">
  <link name="base"/>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="bar"/><axis xyz="0 0 1"/>
  </joint>
  <link name="bar">
    <visual><origin xyz="0.5 0 0"/><geometry><sphere radius="0.1"/></geometry>
      <material name="red"><color rgba="1 0 0 1"/></material></visual>
  </link>
</robot>)";

SceneState state_with(double angle) {
  SceneState state;
  state.base = Eigen::Translation3d(-0.5, 0.0, 1.0);
  state.joints["turn"] = angle;
  return state;
}

// Mean pixel and number of the red pixels.
std::pair<Eigen::Vector2d, int> red_spot(const cv::Mat& image) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3b& bgr = image.at<cv::Vec3b>(y, x);
      if (bgr[2] < 100 || bgr[1] > 30 || bgr[0] > 30) continue;
      sum += Eigen::Vector2d(x, y);
      ++count;
    }
  }
  return {sum / std::max(1, count), count};
}

TEST(SceneRenderer, DrawsALinkWhereItsJointPutsIt) {
  const SceneRenderer renderer(kRobot, camera_sim::TargetBox{});
  const camera_sim::PinholeCamera camera;
  const Isometry3d view = look_at({-0.5, -3.0, 1.2}, {-0.5, 0.0, 1.0});
  for (const double angle : {0.0, 0.7, 3.0}) {
    const auto [centre, count] = red_spot(renderer.render(state_with(angle), camera, view));
    const Vector3d ball =
        view.inverse() * Vector3d(-0.5 + 0.5 * std::cos(angle), 0.5 * std::sin(angle), 1.0);
    const Vector3d expected(camera.fx * ball.x() / ball.z() + camera.cx,
                            camera.fy * ball.y() / ball.z() + camera.cy, 0.0);
    EXPECT_LT((centre - expected.head<2>()).norm(), 1.0) << "at " << angle;
    const double radius = camera.fx * 0.1 / ball.z();
    EXPECT_NEAR(count, M_PI * radius * radius, 0.1 * M_PI * radius * radius);
  }
}

TEST(SceneRenderer, HidesWhatIsBehindTheBox) {
  const SceneRenderer renderer(kRobot, camera_sim::TargetBox{});
  SceneState state = state_with(0.0);
  state.base = Eigen::Translation3d(0.25, 0.0, 1.23);  // the ball is in the box
  EXPECT_GT(red_spot(renderer.render(state, camera_sim::PinholeCamera{},
                                     look_at({-1, 0, 1.2}, {0.8, 0, 1.2})))
                .second,
            100);
  EXPECT_EQ(red_spot(renderer.render(state, camera_sim::PinholeCamera{},
                                     look_at({3, 0, 1.2}, {0.8, 0, 1.2})))
                .second,
            0);
}

TEST(SceneRenderer, LooksUprightAtItsTarget) {
  const Isometry3d view = look_at({1.0, 2.0, 3.0}, {-1.0, 0.5, 0.2});
  const Vector3d target = view.inverse() * Vector3d(-1.0, 0.5, 0.2);
  EXPECT_NEAR(target.head<2>().norm(), 0.0, 1e-12);
  EXPECT_GT(target.z(), 0.0);
  EXPECT_NEAR(view.linear().col(0).z(), 0.0, 1e-12);
  EXPECT_LT(view.linear().col(1).z(), 0.0);
  EXPECT_NEAR(view.linear().determinant(), 1.0, 1e-12);
}

TEST(SceneRenderer, RefusesWhatItCannotDraw) {
  EXPECT_THROW(SceneRenderer("<robot", camera_sim::TargetBox{}), std::invalid_argument);
  EXPECT_THROW(SceneRenderer(R"(<robot name="r"><link name="a"><visual><geometry>
      <mesh filename="x.stl"/></geometry></visual></link></robot>)",
                             camera_sim::TargetBox{}),
               std::invalid_argument);
  const SceneRenderer renderer(kRobot, camera_sim::TargetBox{});
  EXPECT_THROW((void)renderer.render(SceneState{}, camera_sim::PinholeCamera{},
                                     look_at({1, 0, 1}, {0, 0, 1})),
               std::invalid_argument);
}

}  // namespace
}  // namespace scene_drawing
