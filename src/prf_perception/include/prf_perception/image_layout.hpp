// SPDX-License-Identifier: BSD-3-Clause
// Whether the numbers that describe an image fit each other and its data, checked before any
// library reads the data.
#pragma once

#include <cstdint>
#include <string>

namespace prf_perception {

// As sensor_msgs/Image describes an image.
struct ImageLayout {
  std::string encoding;      // of sensor_msgs/image_encodings.h, of the list in validate()
  std::uint32_t width = 0;   // px
  std::uint32_t height = 0;  // px
  std::uint32_t step = 0;    // bytes from one row to the next
  std::uint64_t bytes = 0;   // of the data

  // Throws std::invalid_argument with name, value and bound unless the encoding is mono, bgr, rgb,
  // bgra, rgba or bayer of 8 or 16 bits, yuv422, or 8UC1; width and height are 32 .. 8192 px, a row
  // fits into the step, and the data have exactly height steps.
  void validate() const;
};

}  // namespace prf_perception
