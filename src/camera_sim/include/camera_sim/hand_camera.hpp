// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>

#include "camera_sim/camera_renderer.hpp"
#include "camera_sim/camera_schedule.hpp"
#include "camera_sim/image_noise.hpp"

namespace camera_sim {

/// The camera on the hand. The brightness of the scene goes up and down with the time t, s, of the
/// frame's stamp:
///   image = gain(t) scene + noise,  gain(t) = 1 + light_change sin(2 pi t / light_period + phase).
struct HandCameraParams {
  PinholeCamera optics;
  CameraTiming timing;
  double noise = 0.0;         ///< standard deviation, grey levels
  double light_change = 0.0;  ///< relative amplitude, 0..0.9
  double light_period = 5.0;  ///< s
  int clutter = 0;            ///< posters in the room, 0..Clutter::kMost
  std::uint64_t seed = 0;     ///< of noise, phase of the light, posters

  /// Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

/// Images of the hand camera: the scene, the hand and the fingers, which are fixed links of the
/// robot description and do not move in the image, light and noise.
class HandCamera {
 public:
  /// Throws std::invalid_argument for a bad config or a robot without camera_optical_frame.
  HandCamera(const std::string& urdf_xml, const TargetBox& target, const HandCameraParams& config);

  [[nodiscard]] cv::Mat image(const Frame& frame) const;
  [[nodiscard]] double gain(double time) const;
  [[nodiscard]] const PinholeCamera& optics() const { return config_.optics; }

 private:
  HandCameraParams config_;
  CameraRenderer renderer_;
  ImageNoise noise_;
  double light_phase_;
  // The hand, where it is in view: its grey levels times its coverage, and 1 - coverage.
  cv::Rect hand_bounds_;
  cv::Mat hand_, transparency_;
};

}  // namespace camera_sim
