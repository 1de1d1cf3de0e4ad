// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/tag_detector.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>
#include <string>

#include "rendered_tag.hpp"

namespace prf_perception {
namespace {

TagDetectorParams good_params() {
  TagDetectorParams params;
  params.family = "tag36h11";
  params.tag_size = 0.10;
  params.max_hamming = 1;
  params.min_decision_margin = 20;
  params.quad_decimate = 2;
  params.min_white_black_diff = 30;
  params.error_model = {0.06, 0.0003, 0.002};
  return params;
}

cv::Mat grey_image() { return cv::Mat(480, 640, CV_8UC1, cv::Scalar(110)); }

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(a.linear() * b.linear().transpose())).angle();
}

// Translation and rotation vector from `truth` to `found`, about the optical axes.
Eigen::Matrix<double, 6, 1> error_of(const Eigen::Isometry3d& found,
                                     const Eigen::Isometry3d& truth) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(found.linear() * truth.linear().transpose()));
  Eigen::Matrix<double, 6, 1> error;
  error << found.translation() - truth.translation(), turn.angle() * turn.axis();
  return error;
}

class TagDetectorPose : public ::testing::TestWithParam<double> {};

TEST_P(TagDetectorPose, IsThatOfTheRenderedTag) {
  auto params = good_params();
  params.quad_decimate = GetParam();
  TagDetector detector(params);
  cv::RNG random(7);
  for (int trial = 0; trial < 60; ++trial) {
    const double distance = random.uniform(0.25, 0.8);
    const auto truth = tag_pose(
        {random.uniform(-0.2, 0.2) * distance, random.uniform(-0.15, 0.15) * distance, distance},
        random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), random.uniform(-3.1, 3.1));
    cv::Mat image = grey_image();
    draw_tag(image, test_camera(), params.tag_size, 0, truth);
    add_noise(image, 4, random);
    const auto found = detector.detect(view_of(image), test_camera());
    ASSERT_EQ(found.size(), 1u) << "trial " << trial;
    EXPECT_EQ(found[0].id, 0);
    EXPECT_EQ(found[0].hamming, 0);
    const auto& pose = found[0].pose.marker_in_camera;
    const Eigen::Vector3d error = pose.translation() - truth.translation();
    EXPECT_LT(error.head<2>().norm(), 0.3e-3) << "trial " << trial;
    EXPECT_LT(std::abs(error.z()), 3e-3 * distance) << "trial " << trial;
    EXPECT_LT(angle_between(pose, truth), 0.03) << "trial " << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Decimation, TagDetectorPose, ::testing::Values(1.0, 2.0));

TEST(TagDetector, HasNoBiasOfHalfAPixel) {
  for (const double decimate : {1.0, 2.0}) {
    auto params = good_params();
    params.quad_decimate = decimate;
    TagDetector detector(params);
    cv::RNG random(3);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    constexpr int kTrials = 40;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto truth = tag_pose({random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 0.5},
                                  0, 0, random.uniform(-3.1, 3.1));
      cv::Mat image = grey_image();
      draw_tag(image, test_camera(), params.tag_size, 0, truth);
      const auto found = detector.detect(view_of(image), test_camera());
      ASSERT_EQ(found.size(), 1u);
      const auto expected = project_corners(truth, params.tag_size, test_camera());
      for (std::size_t i = 0; i < 4; ++i) sum += (found[0].corners[i] - expected[i]) / 4;
    }
    EXPECT_LT((sum / kTrials).norm(), 0.03) << "px, decimation " << decimate;
  }
}

TEST(TagDetector, PutsZOutOfTheFaceYUpAndXRight) {
  TagDetector detector(good_params());
  cv::Mat image = grey_image();
  draw_tag(image, test_camera(), 0.1, 0, tag_pose({0.02, 0.01, 0.3}));
  const auto found = detector.detect(view_of(image), test_camera());
  ASSERT_EQ(found.size(), 1u);
  const Eigen::Matrix3d R = found[0].pose.marker_in_camera.linear();
  EXPECT_GT(R.col(0).dot(Eigen::Vector3d::UnitX()), 0.999);
  EXPECT_GT(R.col(1).dot(-Eigen::Vector3d::UnitY()), 0.999);
  EXPECT_GT(R.col(2).dot(-Eigen::Vector3d::UnitZ()), 0.999);
  const auto& corners = found[0].corners;
  EXPECT_LT(corners[0].x(), corners[1].x()) << "lower left is left of lower right";
  EXPECT_GT(corners[0].y(), corners[3].y()) << "lower left is below upper left";
}

TEST(TagDetector, GivesCovarianceThatMatchesItsErrors) {
  auto params = good_params();
  params.error_model.position_floor = 1e-6;
  params.error_model.orientation_floor = 1e-6;
  TagDetector detector(params);
  cv::RNG random(11);
  for (const double distance : {0.3, 0.6}) {
    double nees = 0;
    constexpr int kTrials = 60;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto truth =
          tag_pose({random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), distance},
                   random.uniform(0.3, 0.6), random.uniform(0.2, 0.5), random.uniform(-0.5, 0.5));
      cv::Mat image = grey_image();
      draw_tag(image, test_camera(), params.tag_size, 0, truth);
      add_noise(image, 4, random);
      const auto found = detector.detect(view_of(image), test_camera());
      ASSERT_EQ(found.size(), 1u);
      const Matrix6d P = found[0].pose.covariance;
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(P).eigenvalues().minCoeff(), 0);
      const auto error = error_of(found[0].pose.marker_in_camera, truth);
      nees += error.dot(P.ldlt().solve(error)) / kTrials;
    }
    // Six degrees of freedom; 4.6 and 4.5 were found, the mean of 60 deviates by 0.35.
    EXPECT_GT(nees, 3.6) << distance << " m: model too pessimistic";
    EXPECT_LT(nees, 5.6) << distance << " m: model too optimistic";
  }
}

TEST(TagDetector, FindsNothingInABlankImage) {
  TagDetector detector(good_params());
  const cv::Mat image = grey_image();
  EXPECT_TRUE(detector.detect(view_of(image), test_camera()).empty());
}

TEST(TagDetector, OrdersSeveralTagsById) {
  TagDetector detector(good_params());
  cv::Mat image = grey_image();
  draw_tag(image, test_camera(), 0.1, 7, tag_pose({-0.1, 0, 0.6}));
  draw_tag(image, test_camera(), 0.1, 2, tag_pose({0.1, 0, 0.6}));
  const auto found = detector.detect(view_of(image), test_camera());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].id, 2);
  EXPECT_EQ(found[1].id, 7);
}

TEST(TagDetector, RefusesImageOfAnotherSizeThanTheCamera) {
  TagDetector detector(good_params());
  const cv::Mat small(240, 320, CV_8UC1, cv::Scalar(0));
  EXPECT_THROW((void)detector.detect(view_of(small), test_camera()), std::invalid_argument);
  EXPECT_THROW((void)detector.detect(ImageView{}, test_camera()), std::invalid_argument);
}

TEST(TagDetector, RefusesImagesTooSmallForLibapriltag) {
  TagDetector detector(good_params());
  for (const int size : {1, 8, 31}) {
    const cv::Mat tiny(size, size, CV_8UC1, cv::Scalar(200));
    const CameraIntrinsics camera{10, 10, 1, 1, size, size};
    EXPECT_THROW((void)detector.detect(view_of(tiny), camera), std::invalid_argument);
  }
  const cv::Mat small(32, 32, CV_8UC1, cv::Scalar(200));
  EXPECT_TRUE(detector.detect(view_of(small), {10, 10, 1, 1, 32, 32}).empty());
}

TEST(TagDetector, RefusesCameraWithoutFocalLength) {
  TagDetector detector(good_params());
  const cv::Mat image = grey_image();
  auto camera = test_camera();
  camera.fx = 0;
  EXPECT_THROW((void)detector.detect(view_of(image), camera), std::invalid_argument);
  camera.fx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)detector.detect(view_of(image), camera), std::invalid_argument);
}

TEST(TagDetectorParams, NameTheValueThatIsOutOfBounds) {
  struct BadValue {
    std::string name;
    void (*spoil)(TagDetectorParams&);
  };
  const BadValue catalogue[] = {
      {"tag_family", [](TagDetectorParams& p) { p.family = "tag99"; }},
      {"tag_size", [](TagDetectorParams& p) { p.tag_size = 0; }},
      {"tag_size", [](TagDetectorParams& p) { p.tag_size = std::nan(""); }},
      {"max_hamming", [](TagDetectorParams& p) { p.max_hamming = 3; }},
      {"max_hamming", [](TagDetectorParams& p) { p.max_hamming = -1; }},
      {"min_decision_margin", [](TagDetectorParams& p) { p.min_decision_margin = -1; }},
      {"quad_decimate", [](TagDetectorParams& p) { p.quad_decimate = 0.5; }},
      {"min_white_black_diff", [](TagDetectorParams& p) { p.min_white_black_diff = 0; }},
      {"corner_sigma", [](TagDetectorParams& p) { p.error_model.corner_sigma = 0; }},
      {"position_floor", [](TagDetectorParams& p) { p.error_model.position_floor = -1; }},
      {"orientation_floor",
       [](TagDetectorParams& p) { p.error_model.orientation_floor = std::nan(""); }},
  };
  EXPECT_NO_THROW(good_params().validate());
  for (const auto& bad : catalogue) {
    auto params = good_params();
    bad.spoil(params);
    try {
      params.validate();
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(bad.name + " = ", 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace prf_perception
