// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/image_layout.hpp"

#include <algorithm>
#include <array>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <string_view>

#include "prf_perception/camera.hpp"

namespace prf_perception {
namespace {

struct Encoding {
  std::string_view name;
  std::uint64_t bytes_per_pixel;
};
// What cv_bridge turns into grey; and 8UC1, which drivers publish for mono8.
constexpr std::array<Encoding, 20> kEncodings{
    {{"mono8", 1},        {"8UC1", 1},         {"mono16", 2},       {"bgr8", 3},
     {"rgb8", 3},         {"bgra8", 4},        {"rgba8", 4},        {"bgr16", 6},
     {"rgb16", 6},        {"bgra16", 8},       {"rgba16", 8},       {"bayer_rggb8", 1},
     {"bayer_bggr8", 1},  {"bayer_gbrg8", 1},  {"bayer_grbg8", 1},  {"bayer_rggb16", 2},
     {"bayer_bggr16", 2}, {"bayer_gbrg16", 2}, {"bayer_grbg16", 2}, {"yuv422", 2}}};
constexpr std::size_t kLongestName = 30;  // that is quoted

}  // namespace

// All products are of 64 bits: two factors of a message multiply to beyond 32.
void ImageLayout::validate() const {
  const auto* found =
      std::find_if(kEncodings.begin(), kEncodings.end(),
                   [this](const Encoding& known) { return known.name == encoding; });
  prf_core::require(found != kEncodings.end(), "encoding",
                    prf_core::quoted(encoding.substr(0, kLongestName)),
                    "mono, bgr(a), rgb(a) or bayer_ of 8 or 16 bits, yuv422 or 8UC1");
  prf_core::require_between("image width", width, kSmallestImage, kLargestImage, "px");
  prf_core::require_between("image height", height, kSmallestImage, kLargestImage, "px");
  prf_core::require(encoding != "yuv422" || width % 2 == 0, "image width", width,
                    "even: two pixels of yuv422 share their colour");
  const std::uint64_t row = found->bytes_per_pixel * width;
  prf_core::require(step >= row, "image step", step,
                    "at least " + std::to_string(row) + " bytes, one row of " + encoding);
  const std::uint64_t wanted = std::uint64_t{step} * height;
  prf_core::require(bytes == wanted, "length of the image's data", bytes,
                    std::to_string(wanted) + " bytes, step times height");
}

}  // namespace prf_perception
