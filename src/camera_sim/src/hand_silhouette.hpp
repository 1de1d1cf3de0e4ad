// SPDX-License-Identifier: BSD-3-Clause
// What a camera on the hand always sees of the hand itself.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "camera_sim/pinhole_camera.hpp"

namespace camera_sim {

struct Silhouette {
  cv::Rect bounds;   // empty when nothing of the hand is in view
  cv::Mat shade;     // within the bounds, CV_32F: grey levels times coverage
  cv::Mat coverage;  // the same, 0..1
};

// Of the visual shapes of all links that fixed joints hold to camera_optical_frame, but the
// camera's own. Throws std::invalid_argument if there is no such frame or a shape cannot be drawn.
[[nodiscard]] Silhouette hand_silhouette(const std::string& urdf_xml, const PinholeCamera& camera);

}  // namespace camera_sim
