// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace prf_perception {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr CameraIntrinsics kCamera{615, 610, 320, 240, 640, 480, {0.1, -0.2, 8e-4, -6e-4, 0.08}};

std::string refusal_of(const CameraIntrinsics& camera) {
  try {
    camera.validate();
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(CameraIntrinsics, AcceptsCamerasOfAllKinds) {
  EXPECT_EQ(refusal_of(kCamera), "");
  EXPECT_EQ(refusal_of({615, 615, 320, 240, 640, 480, {}}), "");
  // A wide lens, a tele lens, a sensor of 20 megapixels, an image cut out of a larger one.
  EXPECT_EQ(refusal_of({290, 290, 320, 240, 640, 480, {-0.27, 0.06, 1e-3, -1e-3, -0.004}}), "");
  EXPECT_EQ(refusal_of({9000, 9000, 650, 500, 1280, 1024, {-0.2, 15.0, 1e-3, 2e-3, -200.0}}), "");
  EXPECT_EQ(refusal_of({3700, 3700, 2700, 1800, 5472, 3648, {-0.1, 0.1, 0.0, 0.0, 0.0}}), "");
  EXPECT_EQ(refusal_of({900, 900, -100, 400, 320, 240, {}}), "");
  EXPECT_EQ(refusal_of({900, 900, -540, 400, 100, 100, {}}), "") << "a window in a corner";
  EXPECT_EQ(refusal_of({615, 615, 320, 240, 640, 480, {0.4, 0, 0, 0, 0, 0.7, 0.1, 0.01}}), "");
  constexpr LensModel kFisheye = LensModel::kEquidistant;
  EXPECT_EQ(refusal_of({615, 615, 320, 240, 640, 480, {}, kFisheye}), "");
  EXPECT_EQ(refusal_of({170, 170, 320, 240, 640, 480, {-0.03, 0.01}, kFisheye}), "") << "180 deg";
}

// Fault 44: absurd focal lengths, axis, size or lens -> refused by name before a library sees
// it
TEST(CameraIntrinsics, NameTheValueThatNoCameraHas) {
  struct BadValue {
    std::string name;
    void (*spoil)(CameraIntrinsics&, double);
    std::vector<double> values;
  };
  const std::vector<double> absurd{kNan, kInfinity, -kInfinity, 1e308, -1e308, 1e9, -1e9};
  std::vector<double> lengths = absurd;
  for (const double value : {0.0, -615.0, 1e-6, 5e-324, 6.0, 1e6}) lengths.push_back(value);
  std::vector<double> sizes{0, -1, 31, 8193, 2147483647.0};
  const BadValue catalogue[] = {
      {"camera fx", [](CameraIntrinsics& c, double v) { c.fx = v; }, lengths},
      {"camera fy", [](CameraIntrinsics& c, double v) { c.fy = v; }, lengths},
      {"camera fx / fy", [](CameraIntrinsics& c, double v) { c.fy = v; }, {70, 1300}},
      {"camera cx", [](CameraIntrinsics& c, double v) { c.cx = v; }, absurd},
      {"camera cy", [](CameraIntrinsics& c, double v) { c.cy = v; }, absurd},
      {"camera width", [](CameraIntrinsics& c, double v) { c.width = static_cast<int>(v); }, sizes},
      {"camera height", [](CameraIntrinsics& c, double v) { c.height = static_cast<int>(v); },
       sizes},
      {"camera distortion", [](CameraIntrinsics& c, double v) { c.distortion[0] = v; }, absurd},
      {"camera distortion", [](CameraIntrinsics& c, double v) { c.distortion[1] = v; }, absurd},
      {"camera distortion", [](CameraIntrinsics& c, double v) { c.distortion[2] = v; }, absurd},
      {"camera distortion", [](CameraIntrinsics& c, double v) { c.distortion[3] = v; }, absurd},
      {"camera distortion", [](CameraIntrinsics& c, double v) { c.distortion[4] = v; }, absurd},
      {"camera distortion",
       [](CameraIntrinsics& c, double v) { c.distortion[0] = v; },
       {-3.0, 300.0}},
      {"camera distortion",
       [](CameraIntrinsics& c, double v) { c.distortion[2] = v; },
       {-0.5, 0.5}},
      {"camera distortion", [](CameraIntrinsics& c, double v) { c.distortion[5] = v; }, absurd},
      {"camera distortion",
       [](CameraIntrinsics& c, double v) { c.distortion[5] = v; },
       {-8.0, 9.0}},
      {"camera distortion",
       [](CameraIntrinsics& c, double v) {
         c.distortion = {v};
         c.lens = LensModel::kEquidistant;
       },
       {kNan, kInfinity, 1e308, -1e308, -3.0, 30.0}},
  };
  for (const BadValue& bad : catalogue) {
    for (const double value : bad.values) {
      CameraIntrinsics camera = kCamera;
      bad.spoil(camera, value);
      EXPECT_EQ(refusal_of(camera).rfind(bad.name, 0), 0U) << bad.name << " = " << value;
    }
  }
}

}  // namespace
}  // namespace prf_perception
