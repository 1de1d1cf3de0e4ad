// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/camera_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace camera_sim {
namespace {

constexpr double kFramesPerSecond = 30.0;
constexpr double kInstantSpacing = 3.0;     // ms
constexpr double kLongestLatency = 0.5;     // s
constexpr double kLongestExposure = 0.016;  // s, half a frame
constexpr double kTolerance = 1e-6;         // ms, of decimal figures in seconds

std::int64_t stamp_of(std::uint64_t index, std::int64_t first_ms) {
  return first_ms + std::llround(static_cast<double>(index) * 1000.0 / kFramesPerSecond);
}

}  // namespace

void CameraTiming::validate() const {
  prf_core::require_between("latency", latency, 0.0, kLongestLatency, "s");
  prf_core::require_between("exposure", exposure, 0.0, kLongestExposure, "s");
}

CameraSchedule::CameraSchedule(const CameraTiming& timing, std::int64_t first_ms)
    : first_ms_(first_ms),
      latency_ms_(static_cast<std::int64_t>(std::ceil(1000.0 * timing.latency - kTolerance))) {
  timing.validate();
  const double exposure_ms = 1000.0 * timing.exposure;
  const double count = std::max(1.0, std::ceil(exposure_ms / kInstantSpacing - kTolerance));
  for (double i = 0.5; i < count; ++i) {
    offsets_ms_.push_back(std::llround((i / count - 0.5) * exposure_ms));
  }
  begin_frame(0);
}

void CameraSchedule::begin_frame(std::uint64_t index) {
  current_ = Frame{};
  current_.index = index;
  current_.stamp_ms = stamp_of(index, first_ms_);
}

bool CameraSchedule::captures_at(std::int64_t now_ms) const {
  return now_ms == current_.stamp_ms + offsets_ms_[current_.views.size()];
}

void CameraSchedule::capture(std::int64_t now_ms, const CameraView& view) {
  if (!captures_at(now_ms)) {
    throw std::invalid_argument("now_ms = " + std::to_string(now_ms) +
                                ", must be an instant of the schedule");
  }
  current_.views.push_back(view);
  if (current_.views.size() < offsets_ms_.size()) return;
  exposed_.push_back(std::move(current_));
  begin_frame(exposed_.back().index + 1);
}

std::optional<Frame> CameraSchedule::take_exposed() {
  if (exposed_.empty()) return std::nullopt;
  Frame frame = std::move(exposed_.front());
  exposed_.pop_front();
  return frame;
}

bool CameraSchedule::is_due(const Frame& frame, std::int64_t now_ms) const {
  return now_ms >= frame.stamp_ms + latency_ms_;
}

}  // namespace camera_sim
