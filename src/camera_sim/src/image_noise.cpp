// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/image_noise.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <stdexcept>

namespace camera_sim {
namespace {

constexpr int kQuantiles = 1 << 16;
constexpr double kMaxSigma = 100.0;

// Steele, Lea, Flood: Fast splittable pseudorandom number generators (2014), figure 17.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

}  // namespace

ImageNoise::ImageNoise(double sigma, std::uint64_t seed) : seed_(seed) {
  prf_core::require_between("noise sigma", sigma, 0.0, kMaxSigma, "grey levels");
  if (sigma == 0.0) return;
  int level = -static_cast<int>(std::ceil(6.0 * sigma));
  for (int i = 0; i < kQuantiles; ++i) {
    while (normal_cdf((level + 0.5) / sigma) < (i + 0.5) / kQuantiles) ++level;
    quantiles_.push_back(static_cast<std::int16_t>(level));
  }
}

void ImageNoise::add(cv::Mat& image, std::uint64_t frame) const {
  if (image.type() != CV_8UC1)
    throw std::invalid_argument("image is of OpenCV type " + std::to_string(image.type()) +
                                ", must be mono8 (CV_8UC1)");
  if (quantiles_.empty()) return;
  std::uint64_t counter = mix(mix(seed_) + frame);
  for (int y = 0; y < image.rows; ++y) {
    unsigned char* row = image.ptr(y);
    std::uint64_t bits = 0;
    for (int x = 0; x < image.cols; ++x) {
      if (x % 4 == 0) bits = mix(counter += 0x9e3779b97f4a7c15ULL);
      const int grey = row[x] + quantiles_[bits & 0xffff];
      row[x] = static_cast<unsigned char>(std::clamp(grey, 0, 255));
      bits >>= 16;
    }
  }
}

}  // namespace camera_sim
