// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/camera.hpp"

#include <algorithm>
#include <cmath>

#include "require.hpp"

namespace prf_perception {

bool distorts(const CameraIntrinsics& camera) {
  const auto& d = camera.distortion;
  return std::any_of(d.begin(), d.end(), [](double value) { return value != 0.0; });
}

void validate(const CameraIntrinsics& camera) {
  require(camera.width > 0, "camera width", camera.width, "> 0 px");
  require(camera.height > 0, "camera height", camera.height, "> 0 px");
  require(camera.fx > 0 && std::isfinite(camera.fx), "camera fx", camera.fx, "finite and > 0 px");
  require(camera.fy > 0 && std::isfinite(camera.fy), "camera fy", camera.fy, "finite and > 0 px");
  require(std::isfinite(camera.cx), "camera cx", camera.cx, "finite");
  require(std::isfinite(camera.cy), "camera cy", camera.cy, "finite");
  for (const double d : camera.distortion) {
    require(std::isfinite(d), "camera distortion", d, "finite");
  }
}

}  // namespace prf_perception
