// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/image_layout.hpp"

#include <algorithm>
#include <array>
#include <prf_core/require.hpp>
#include <string_view>

#include "prf_perception/camera.hpp"

namespace prf_perception {
namespace {

struct Encoding {
  std::string_view name;
  std::uint64_t bytes_per_pixel;
};
constexpr std::array<Encoding, 3> kEncodings{{{"mono8", 1}, {"bgr8", 3}, {"rgb8", 3}}};
constexpr std::size_t kLongestName = 30;  // that is quoted

}  // namespace

// All products are of 64 bits: two factors of a message multiply to beyond 32.
void ImageLayout::validate() const {
  const auto* found =
      std::find_if(kEncodings.begin(), kEncodings.end(),
                   [this](const Encoding& known) { return known.name == encoding; });
  prf_core::require(found != kEncodings.end(), "encoding", encoding.substr(0, kLongestName),
                    "mono8, bgr8 or rgb8");
  prf_core::require_between("image width", width, kSmallestImage, kLargestImage, "px");
  prf_core::require_between("image height", height, kSmallestImage, kLargestImage, "px");
  const std::uint64_t row = found->bytes_per_pixel * width;
  prf_core::require(step >= row, "image step", step,
                    "at least " + std::to_string(row) + " bytes, one row of " + encoding);
  const std::uint64_t wanted = std::uint64_t{step} * height;
  prf_core::require(bytes == wanted, "length of the image's data", bytes,
                    std::to_string(wanted) + " bytes, step times height");
}

}  // namespace prf_perception
