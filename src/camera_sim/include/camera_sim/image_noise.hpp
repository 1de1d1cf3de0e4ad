// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace camera_sim {

/// Gaussian noise of a camera, rounded to whole grey levels. The noisy image is clamped to 0..255.
/// The noise of a frame depends on the seed and the frame's number only.
class ImageNoise {
 public:
  /// `sigma` in grey levels, >= 0; 0 is no noise. Throws std::invalid_argument otherwise.
  ImageNoise(double sigma, std::uint64_t seed);

  /// `image` is mono8; else std::invalid_argument.
  void add(cv::Mat& image, std::uint64_t frame) const;

 private:
  std::uint64_t seed_;
  std::vector<std::int16_t>
      quantiles_;  // rounded normal quantiles at (i + 1/2) / size; empty: none
};

}  // namespace camera_sim
