// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/hand_camera.hpp"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <prf_core/require.hpp>
#include <random>

#include "hand_silhouette.hpp"

namespace camera_sim {
namespace {

constexpr double kLargestNoise = 100.0;                     // grey levels
constexpr std::uint64_t kLightStream = 0x6c69676874000000;  // apart from the seed's other draws

const HandCameraParams& valid(const HandCameraParams& config) {
  config.validate();
  return config;
}

}  // namespace

void HandCameraParams::validate() const {
  optics.validate();
  timing.validate();
  prf_core::require_between("camera noise", noise, 0.0, kLargestNoise, "grey levels");
  prf_core::require_between("camera light_change", light_change, 0.0, 0.9);
  prf_core::require_between("camera light_period", light_period, 0.1, 3600.0, "s");
  prf_core::require_between("camera clutter", clutter, 0, Clutter::kMost);
}

HandCamera::HandCamera(const std::string& urdf_xml, const TargetBox& target,
                       const HandCameraParams& config)
    : config_(valid(config)),
      renderer_(config.optics, target, {config.clutter, config.seed}),
      noise_(config.noise, config.seed) {
  std::mt19937_64 generator(config.seed ^ kLightStream);
  light_phase_ = 2.0 * M_PI * std::ldexp(static_cast<double>(generator() >> 11), -53);
  const Silhouette hand = hand_silhouette(urdf_xml, config.optics);
  hand_bounds_ = hand.bounds;
  hand_ = hand.shade;
  cv::subtract(cv::Scalar(1.0), hand.coverage, transparency_);
}

double HandCamera::gain(double time) const {
  return 1.0 +
         config_.light_change * std::sin(2.0 * M_PI * time / config_.light_period + light_phase_);
}

cv::Mat HandCamera::image(const Frame& frame) const {
  cv::Mat image = renderer_.render(frame.views);
  if (!hand_bounds_.empty()) {
    cv::Mat part = image(hand_bounds_), covered;
    part.convertTo(covered, CV_32F);
    cv::multiply(covered, transparency_, covered);
    cv::add(covered, hand_, part, cv::noArray(), CV_8U);
  }
  if (config_.light_change > 0.0) {
    image.convertTo(image, CV_8U, gain(1e-3 * static_cast<double>(frame.stamp_ms)));
  }
  noise_.add(image, frame.index);
  return image;
}

}  // namespace camera_sim
