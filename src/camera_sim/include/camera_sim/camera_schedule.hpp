// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "camera_sim/camera_renderer.hpp"

namespace camera_sim {

struct CameraTiming {
  double latency = 0.0;   ///< s from the middle of the exposure to publication, 0 .. 0.5
  double exposure = 0.0;  ///< s, length of the exposure around its stamp, 0 .. 0.016

  /// Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

/// One image to be drawn: where camera, platform and the box's carrier are during its exposure.
struct Frame {
  std::uint64_t index = 0;
  std::int64_t stamp_ms = 0;  ///< middle of the exposure
  std::vector<CameraView> views;
};

/// 30 frames a second on the grid of 1 ms: frame k is stamped first_ms + round(1000 k / 30) and
/// seen at instants spread evenly and symmetrically over its exposure. There is one instant for
/// each 3 ms begun, at least one.
class CameraSchedule {
 public:
  CameraSchedule(const CameraTiming& timing, std::int64_t first_ms);

  /// True if a view is to be captured at this millisecond.
  [[nodiscard]] bool captures_at(std::int64_t now_ms) const;
  /// Takes the view of a millisecond for which captures_at() is true; else throws
  /// std::invalid_argument. The caller asks captures_at() for each millisecond: after one that was
  /// left out the schedule stays where it is.
  void capture(std::int64_t now_ms, const CameraView& view);
  /// Completely exposed frames, in order, each handed out once.
  [[nodiscard]] std::optional<Frame> take_exposed();
  /// Whether a frame may be published at the control tick now_ms: `latency` has passed since its
  /// stamp.
  [[nodiscard]] bool is_due(const Frame& frame, std::int64_t now_ms) const;

 private:
  void begin_frame(std::uint64_t index);

  std::int64_t first_ms_;
  std::int64_t latency_ms_;
  std::vector<std::int64_t> offsets_ms_;  // of the instants from the stamp, rising
  Frame current_;
  std::deque<Frame> exposed_;
};

}  // namespace camera_sim
