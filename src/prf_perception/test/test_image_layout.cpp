// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/image_layout.hpp"

#include <gtest/gtest.h>

#include <string>

namespace prf_perception {
namespace {

std::string refusal_of(const ImageLayout& layout) {
  try {
    layout.validate();
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(ImageLayout, AcceptsWholeImagesWithAndWithoutPadding) {
  EXPECT_EQ(refusal_of({"mono8", 640, 480, 640, 640 * 480}), "");
  EXPECT_EQ(refusal_of({"mono8", 600, 480, 640, 640 * 480}), "");
  EXPECT_EQ(refusal_of({"bgr8", 640, 480, 1920, 1920 * 480}), "");
  EXPECT_EQ(refusal_of({"rgb8", 32, 32, 96, 96 * 32}), "");
  EXPECT_EQ(refusal_of({"8UC1", 32, 32, 32, 32 * 32}), "");
  EXPECT_EQ(refusal_of({"mono16", 32, 32, 64, 64 * 32}), "");
  EXPECT_EQ(refusal_of({"bgra8", 32, 32, 128, 128 * 32}), "");
  EXPECT_EQ(refusal_of({"rgba16", 32, 32, 256, 256 * 32}), "");
  EXPECT_EQ(refusal_of({"bayer_grbg8", 32, 32, 32, 32 * 32}), "");
  EXPECT_EQ(refusal_of({"yuv422", 32, 32, 64, 64 * 32}), "");
}

// Fault 44: size and data disagree, also beyond 32 bits -> refused before the data are read
TEST(ImageLayout, RefusesWhatDoesNotFitItsData) {
  // 15790321 * 272 = 16 and 65536 * 65536 = 0 in 32 bits.
  EXPECT_NE(refusal_of({"mono8", 15790321, 272, 15790321, 16}), "");
  EXPECT_NE(refusal_of({"mono8", 272, 8192, 15790321, 16}), "");
  EXPECT_EQ(refusal_of({"mono8", 256, 272, 15790321, 16}),
            "length of the image's data = 16, must be 4294967312 bytes, step times height");
  EXPECT_NE(refusal_of({"mono8", 8192, 4096, 1048576, 0}), "");
  EXPECT_NE(refusal_of({"mono8", 640, 480, 640, 640 * 480 - 1}), "");
  EXPECT_NE(refusal_of({"mono8", 640, 480, 640, 640 * 480 + 1}), "");
  EXPECT_NE(refusal_of({"mono8", 640, 480, 639, 639 * 480}), "");
  EXPECT_NE(refusal_of({"bgr8", 640, 480, 640, 640 * 480}), "") << "three bytes a pixel";
  EXPECT_NE(refusal_of({"mono8", 0, 0, 0, 0}), "");
  EXPECT_NE(refusal_of({"mono16", 640, 480, 640, 640 * 480}), "") << "two bytes a pixel";
  EXPECT_NE(refusal_of({"bgra8", 640, 480, 1920, 1920 * 480}), "") << "four bytes a pixel";
  EXPECT_NE(refusal_of({"yuv422", 641, 480, 1282, 1282 * 480}), "") << "pixels in pairs";
  EXPECT_NE(refusal_of({"mono8", 31, 480, 640, 640 * 480}), "");
  EXPECT_NE(refusal_of({"mono8", 640, 8193, 640, 640 * 8193}), "");
}

// Fault 44: an encoding that is not read, or garbage as its name -> refused, quoted short
TEST(ImageLayout, RefusesOtherEncodings) {
  EXPECT_EQ(refusal_of({"16UC1", 640, 480, 1280, 1280 * 480}),
            "encoding = \"16UC1\", must be mono, bgr(a), rgb(a) or bayer_ of 8 or 16 bits, yuv422 "
            "or 8UC1");
  EXPECT_NE(refusal_of({"", 640, 480, 640, 640 * 480}), "");
  EXPECT_LT(refusal_of({std::string(100000, 'x'), 640, 480, 640, 640 * 480}).size(), 130U);
}

}  // namespace
}  // namespace prf_perception
