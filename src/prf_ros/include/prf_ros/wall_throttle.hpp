// SPDX-License-Identifier: BSD-3-Clause
// Lets a log line through at most once in a period of wall time. ROS_WARN_THROTTLE goes by ROS
// time: in simulated time it says nothing in the first period, and nothing while the clock stands.
//
//   prf_ros::WallThrottle told_;
//   if (told_.is_due()) ROS_WARN("...");
#pragma once

#include <chrono>
#include <optional>

namespace prf_ros {

class WallThrottle {
 public:
  explicit WallThrottle(std::chrono::duration<double> period = std::chrono::seconds(1))
      : period_(period) {}

  // True at the first call, and when the period has passed since it was true last.
  bool is_due() {
    const auto now = std::chrono::steady_clock::now();
    if (last_ && now - *last_ < period_) return false;
    last_ = now;
    return true;
  }

 private:
  std::chrono::duration<double> period_;
  std::optional<std::chrono::steady_clock::time_point> last_;
};

}  // namespace prf_ros
