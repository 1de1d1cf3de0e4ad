// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/camera.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>

namespace prf_perception {

bool CameraIntrinsics::distorts() const {
  return std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0.0; });
}

void CameraIntrinsics::validate() const {
  using prf_core::require;
  require(width > 0, "camera width", width, "> 0 px");
  require(height > 0, "camera height", height, "> 0 px");
  require(fx > 0 && std::isfinite(fx), "camera fx", fx, "finite and > 0 px");
  require(fy > 0 && std::isfinite(fy), "camera fy", fy, "finite and > 0 px");
  prf_core::require_finite("camera cx", cx);
  prf_core::require_finite("camera cy", cy);
  for (const double d : distortion) prf_core::require_finite("camera distortion", d);
}

}  // namespace prf_perception
