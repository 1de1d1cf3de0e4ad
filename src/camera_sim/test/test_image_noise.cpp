// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/image_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace camera_sim {
namespace {

cv::Mat grey_image(int level) { return cv::Mat(480, 640, CV_8UC1, cv::Scalar(level)); }

TEST(ImageNoise, HasTheAskedMeanAndDeviation) {
  for (const double sigma : {1.0, 4.0, 12.0}) {
    cv::Mat image = grey_image(128);
    ImageNoise(sigma, 3).add(image, 0);
    cv::Scalar mean, deviation;
    cv::meanStdDev(image, mean, deviation);
    EXPECT_NEAR(mean[0], 128.0, 0.02 * sigma);
    EXPECT_NEAR(deviation[0], std::sqrt(sigma * sigma + 1.0 / 12.0), 0.01 * sigma);
  }
}

TEST(ImageNoise, IsAFunctionOfSeedAndFrame) {
  const auto noisy = [](std::uint64_t seed, std::uint64_t frame) {
    cv::Mat image = grey_image(128);
    ImageNoise(4.0, seed).add(image, frame);
    return image;
  };
  EXPECT_EQ(cv::countNonZero(noisy(1, 7) != noisy(1, 7)), 0);
  EXPECT_GT(cv::countNonZero(noisy(1, 7) != noisy(1, 8)), 250000);
  EXPECT_GT(cv::countNonZero(noisy(1, 7) != noisy(2, 7)), 250000);
}

TEST(ImageNoise, IsWhiteAcrossNeighboursAndFrames) {
  const ImageNoise noise(8.0, 5);
  cv::Mat now = grey_image(128), next = grey_image(128);
  noise.add(now, 10);
  noise.add(next, 11);
  const auto correlation = [](const cv::Mat& a, const cv::Mat& b) {
    cv::Mat fa, fb;
    a.convertTo(fa, CV_64F, 1.0, -128.0);
    b.convertTo(fb, CV_64F, 1.0, -128.0);
    return fa.dot(fb) / static_cast<double>(fa.total()) / 64.0;
  };
  const cv::Rect left(0, 0, 639, 479), right(1, 0, 639, 479), below(0, 1, 639, 479);
  EXPECT_NEAR(correlation(now(left), now(right)), 0.0, 0.01);
  EXPECT_NEAR(correlation(now(left), now(below)), 0.0, 0.01);
  EXPECT_NEAR(correlation(now, next), 0.0, 0.01);
}

TEST(ImageNoise, ClampsToTheGreyScale) {
  cv::Mat dark = grey_image(0), bright = grey_image(255);
  const ImageNoise noise(4.0, 1);
  noise.add(dark, 0);
  noise.add(bright, 0);
  double highest = 0.0, lowest = 0.0;
  cv::minMaxLoc(dark, nullptr, &highest);
  cv::minMaxLoc(bright, &lowest);
  EXPECT_LT(highest, 40.0);
  EXPECT_GT(lowest, 215.0);
}

TEST(ImageNoise, LeavesTheImageAloneWithoutDeviation) {
  cv::Mat image = grey_image(77);
  ImageNoise(0.0, 1).add(image, 0);
  EXPECT_EQ(cv::countNonZero(image != 77), 0);
}

TEST(ImageNoise, RefusesABadDeviationOrImage) {
  EXPECT_THROW(ImageNoise(-1.0, 0), std::invalid_argument);
  EXPECT_THROW(ImageNoise(std::nan(""), 0), std::invalid_argument);
  cv::Mat colour(4, 4, CV_8UC3);
  EXPECT_THROW(ImageNoise(1.0, 0).add(colour, 0), std::invalid_argument);
}

}  // namespace
}  // namespace camera_sim
