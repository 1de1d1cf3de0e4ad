// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/camera_renderer.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/apriltag_pose.h>
#include <apriltag/tag36h11.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <optional>
#include <random>

namespace camera_sim {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

struct Detection {
  std::array<Eigen::Vector2d, 4> corners;  // lower left, lower right, upper right, upper left
  Isometry3d tag_in_camera = Isometry3d::Identity();  // our tag axes: x right, y up, z out
};

std::optional<Detection> detect(const cv::Mat& image, const PinholeCamera& camera, double size) {
  apriltag_family_t* family = tag36h11_create();
  apriltag_detector_t* detector = apriltag_detector_create();
  apriltag_detector_add_family(detector, family);
  detector->quad_decimate = 1.0F;
  image_u8_t view = {image.cols, image.rows, static_cast<int>(image.step), image.data};
  zarray_t* found = apriltag_detector_detect(detector, &view);

  std::optional<Detection> result;
  if (zarray_size(found) == 1) {
    apriltag_detection_t* tag = nullptr;
    zarray_get(found, 0, &tag);
    // libapriltag counts pixels from the first one's corner: half a pixel more than OpenCV.
    apriltag_detection_info_t info = {
        tag, size, camera.fx, camera.fy, camera.cx + 0.5, camera.cy + 0.5};
    apriltag_pose_t pose;
    estimate_tag_pose(&info, &pose);
    result.emplace();
    for (std::size_t i = 0; i < 4; ++i) {
      result->corners[i] = {tag->p[i][0] - 0.5, tag->p[i][1] - 0.5};
    }
    result->tag_in_camera.translation() = Eigen::Map<Vector3d>(pose.t->data);
    result->tag_in_camera.linear() =
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.R->data) *
        AngleAxisd(M_PI, Vector3d::UnitX()).matrix();
    std::free(pose.R);
    std::free(pose.t);
  }
  apriltag_detections_destroy(found);
  apriltag_detector_destroy(detector);
  tag36h11_destroy(family);
  return result;
}

// Camera that looks at the tag from `distance` along its normal, then moved around it.
CameraView view_of_tag(const TargetBox& target, double distance, double azimuth, double elevation,
                       double roll, const Isometry3d& platform = Isometry3d::Identity()) {
  CameraView view;
  view.platform = view.carrier = platform;
  const Isometry3d around_tag = target.tag_in_platform() * AngleAxisd(azimuth, Vector3d::UnitY()) *
                                AngleAxisd(elevation, Vector3d::UnitX());
  view.camera = platform * around_tag * Eigen::Translation3d(0.0, 0.0, distance) *
                AngleAxisd(M_PI, Vector3d::UnitX()) * AngleAxisd(roll, Vector3d::UnitZ());
  return view;
}

Eigen::Vector2d project(const PinholeCamera& camera, const Vector3d& point) {
  return camera.to_pixel(point.hnormalized());
}

// Errors of libapriltag over random views of the tag from one distance. Its own scatter, on an
// exact rendering, is 0.06-0.09 px; a bias of the mean would be the renderer's.
class TagAtDistance : public ::testing::TestWithParam<double> {};

TEST_P(TagAtDistance, IsRecoveredFromTheImageWithoutBias) {
  constexpr int kViews = 40;
  const TargetBox target;
  const PinholeCamera camera;
  const CameraRenderer renderer(camera, target);
  const Isometry3d platform =
      Eigen::Translation3d(0.01, -0.04, 0.02) * AngleAxisd(0.09, Vector3d::UnitY());
  const double half = 0.5 * target.tag_size;
  const std::array<Vector3d, 4> corners = {Vector3d(-half, -half, 0.0), Vector3d(half, -half, 0.0),
                                           Vector3d(half, half, 0.0), Vector3d(-half, half, 0.0)};
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);

  Eigen::Vector2d corner_bias = Eigen::Vector2d::Zero();
  Vector3d position_bias = Vector3d::Zero(), position_square = Vector3d::Zero();
  double corner_square = 0.0;
  for (int i = 0; i < kViews; ++i) {
    CameraView view = view_of_tag(target, GetParam(), 0.25 * uniform(generator),
                                  0.12 * uniform(generator), 0.3 * uniform(generator), platform);
    view.camera = view.camera * AngleAxisd(0.04 * uniform(generator), Vector3d::UnitY()) *
                  AngleAxisd(0.04 * uniform(generator), Vector3d::UnitX());
    const std::optional<Detection> found = detect(renderer.render(view), camera, target.tag_size);
    ASSERT_TRUE(found) << "view " << i;
    const Isometry3d tag_in_camera = view.camera.inverse() * platform * target.tag_in_platform();
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector2d error = found->corners[k] - project(camera, tag_in_camera * corners[k]);
      corner_bias += error / (4 * kViews);
      corner_square += error.squaredNorm() / (4 * kViews);
    }
    const Vector3d error = found->tag_in_camera.translation() - tag_in_camera.translation();
    position_bias += error / kViews;
    position_square += error.cwiseAbs2() / kViews;
    EXPECT_LT(
        AngleAxisd(found->tag_in_camera.linear().transpose() * tag_in_camera.linear()).angle(),
        0.05);
  }
  EXPECT_LT(corner_bias.norm(), 0.02);
  EXPECT_LT(std::sqrt(corner_square), 0.12);
  EXPECT_LT(position_bias.head<2>().norm(), 0.02e-3);
  EXPECT_LT(std::sqrt(position_square.head<2>().maxCoeff()), 0.1e-3);
  EXPECT_LT(std::sqrt(position_square.z()), 0.6e-3 * GetParam() / 0.6);
}

INSTANTIATE_TEST_SUITE_P(CameraRenderer, TagAtDistance, ::testing::Values(0.3, 0.45, 0.6, 0.8));

class Lens : public ::testing::TestWithParam<std::array<double, 5>> {};

INSTANTIATE_TEST_SUITE_P(CameraRenderer, Lens,
                         ::testing::Values(std::array<double, 5>{},
                                           std::array<double, 5>{0.1, -0.2, 0.001, -0.002, 0.1},
                                           std::array<double, 5>{-0.3, 0.1, 0.0, 0.0, 0.0}));

TEST_P(Lens, AgreesWithTheMeanOfAFinerImage) {
  constexpr int kFiner = 6, kLeft = 200, kTop = 120, kWide = 240;  // px: the tag and its border
  const TargetBox target;
  PinholeCamera camera;
  camera.distortion = GetParam();
  PinholeCamera fine = camera;
  fine.width = kWide * kFiner;
  fine.height = kWide * kFiner;
  fine.fx *= kFiner;
  fine.fy *= kFiner;
  fine.cx = kFiner * (camera.cx + 0.5 - kLeft) - 0.5;
  fine.cy = kFiner * (camera.cy + 0.5 - kTop) - 0.5;
  const CameraView view = view_of_tag(target, 0.30, 0.05, 0.02, 0.1);
  const cv::Mat image = CameraRenderer(camera, target).render(view);
  const cv::Mat finer = CameraRenderer(fine, target).render(view);
  int worst = 0;
  for (int y = 0; y < kWide; ++y) {
    for (int x = 0; x < kWide; ++x) {
      const cv::Rect pixel(x * kFiner, y * kFiner, kFiner, kFiner);
      const int mean = static_cast<int>(std::lround(cv::mean(finer(pixel))[0]));
      worst = std::max(worst, std::abs(mean - image.at<unsigned char>(kTop + y, kLeft + x)));
    }
  }
  EXPECT_LE(worst, 8);  // of 200 grey levels between ink and paper: 0.04 px
}

// Without the tag: the mean over random lines of sight of what an ideal camera sees there.
TEST_P(Lens, ShowsWhatAnIdealCameraSeesAlongTheSameLines) {
  TargetBox target;
  target.on_cart = true;
  PinholeCamera camera, ideal;
  camera.distortion = GetParam();
  ideal.width = ideal.height = 2000;
  ideal.cx = ideal.cy = 1000.0;
  const CameraView view = view_of_tag(target, 0.7, 0.3, 0.2, 0.4);
  const cv::Mat image = CameraRenderer(camera, target, {60, 5}).render(view);
  const cv::Mat reference = CameraRenderer(ideal, target, {60, 5}).render(view);
  int compared = 0, different = 0;
  for (int y = 0; y < camera.height; y += 3) {
    for (int x = 0; x < camera.width; x += 3) {
      const Eigen::Vector2d there = ideal.to_pixel(camera.to_normalised(Eigen::Vector2d(x, y)));
      const auto u = static_cast<int>(std::lround(there.x()));
      const auto v = static_cast<int>(std::lround(there.y()));
      double darkest = 0.0, brightest = 0.0;
      cv::minMaxLoc(reference(cv::Rect(u - 2, v - 2, 5, 5)), &darkest, &brightest);
      const int grey = image.at<unsigned char>(y, x);
      ++compared;
      different += grey < darkest - 1 || grey > brightest + 1 ? 1 : 0;
    }
  }
  EXPECT_LT(different, 1e-3 * compared);  // corners finer than a pixel
}

TEST(CameraRenderer, FollowsTheCartButLeavesTheFloor) {
  TargetBox target;
  target.on_cart = true;
  const CameraRenderer renderer(PinholeCamera{}, target);
  CameraView view = view_of_tag(target, 0.6, 0, 0, 0);
  const auto before = detect(renderer.render(view), PinholeCamera{}, 0.1);
  view.carrier.translation() = Vector3d(0.0, 0.12, 0.0);
  const auto after = detect(renderer.render(view), PinholeCamera{}, 0.1);
  ASSERT_TRUE(before && after);
  const Vector3d moved = view.camera.linear() *
                         (after->tag_in_camera.translation() - before->tag_in_camera.translation());
  EXPECT_LT((moved - Vector3d(0.0, 0.12, 0.0)).norm(), 1.5e-3);
}

TEST(CameraRenderer, CentresASymmetricViewOnThePrincipalPoint) {
  const PinholeCamera camera;
  const TargetBox target;
  const auto found =
      detect(CameraRenderer(camera, target).render(view_of_tag(target, 0.4, 0, 0, 0)), camera,
             target.tag_size);
  ASSERT_TRUE(found);
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : found->corners) centre += 0.25 * corner;
  EXPECT_LT((centre - Eigen::Vector2d(camera.cx, camera.cy)).norm(), 0.02);
}

TEST(CameraRenderer, HidesTheTagBehindTheBoxWalls) {
  const PinholeCamera camera;
  const TargetBox target;
  const CameraRenderer renderer(camera, target);
  EXPECT_FALSE(detect(renderer.render(view_of_tag(target, 0.6, M_PI, 0, 0)), camera, 0.1));
  EXPECT_FALSE(detect(renderer.render(view_of_tag(target, 0.6, 1.45, 0, 0)), camera, 0.1));
  EXPECT_TRUE(detect(renderer.render(view_of_tag(target, 0.6, 0.3, 0, 0)), camera, 0.1));
}

TEST(CameraRenderer, PaintsEveryPixelFromAnywhereInTheRoom) {
  const CameraRenderer renderer(PinholeCamera{}, TargetBox{});
  for (const Vector3d& place : {Vector3d(0.1, 0.0, 0.8), Vector3d(0.78, 0.02, 1.25),
                                Vector3d(0.89, 0.0, 0.0), Vector3d(1.4, 0.3, 2.0)}) {
    for (int i = 0; i < 12; ++i) {
      CameraView view;
      view.camera =
          Eigen::Translation3d(place) * AngleAxisd(0.7 * i, Vector3d(1, i % 5 - 2, 1).normalized());
      const cv::Mat image = renderer.render(view);
      double darkest = 0.0;
      cv::minMaxLoc(image, &darkest);
      EXPECT_GT(darkest, 0.0);
    }
  }
}

TEST(CameraRenderer, RendersEqualViewsEqually) {
  const TargetBox target;
  const CameraView view = view_of_tag(target, 0.5, 0.2, 0.1, 0.0);
  const cv::Mat first = CameraRenderer(PinholeCamera{}, target).render(view);
  const cv::Mat second = CameraRenderer(PinholeCamera{}, target).render(view);
  EXPECT_EQ(cv::countNonZero(first != second), 0);
}

TEST(CameraRenderer, BlursAlongTheMotionDuringTheExposure) {
  const TargetBox target;
  const PinholeCamera camera;
  const CameraRenderer renderer(camera, target);
  std::vector<CameraView> exposure;
  for (int i = -2; i <= 2; ++i) {
    exposure.push_back(view_of_tag(target, 0.5, 0, 0, 0));
    exposure.back().camera.translation().y() += 0.0008 * i;  // about 4 px in all
  }
  const cv::Mat blurred = renderer.render(exposure);
  const cv::Mat sharp = renderer.render(exposure[2]);
  EXPECT_GT(cv::countNonZero(blurred != sharp), 1000);
  cv::Mat sum(camera.height, camera.width, CV_64FC1, cv::Scalar(0));
  for (const CameraView& view : exposure) cv::add(sum, renderer.render(view), sum, {}, CV_64F);
  cv::Mat difference;
  cv::subtract(sum / 5.0, blurred, difference, {}, CV_64F);
  EXPECT_LE(cv::norm(difference, cv::NORM_INF), 0.5);
  const auto found = detect(blurred, camera, target.tag_size);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->tag_in_camera.translation().x(), 0.0, 0.2e-3);
}

TEST(CameraRenderer, RefusesNonsense) {
  PinholeCamera camera;
  camera.fx = 0.0;
  EXPECT_THROW(CameraRenderer(camera, TargetBox{}), std::invalid_argument);
  camera = PinholeCamera{};
  camera.width = 0;
  EXPECT_THROW(CameraRenderer(camera, TargetBox{}), std::invalid_argument);
  camera = PinholeCamera{};
  camera.cy = std::nan("");
  EXPECT_THROW(CameraRenderer(camera, TargetBox{}), std::invalid_argument);
  TargetBox target;
  target.tag_size = -1.0;
  EXPECT_THROW(CameraRenderer(PinholeCamera{}, target), std::invalid_argument);
  EXPECT_THROW((void)CameraRenderer(PinholeCamera{}, TargetBox{}).render(std::vector<CameraView>{}),
               std::invalid_argument);
}

}  // namespace
}  // namespace camera_sim
