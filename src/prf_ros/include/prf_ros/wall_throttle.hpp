// SPDX-License-Identifier: BSD-3-Clause
// Let a log line through at most once in a period of wall time. ROS_WARN_THROTTLE goes by ROS
// time: in simulated time it says nothing in the first period, and nothing while the clock stands.
// And all that one such line says shares its period, so that one reason hides another.
//
//   prf_ros::WallThrottle told_;
//   if (told_.is_due()) ROS_WARN("...");
//
//   prf_ros::WallThrottles told_of_;
//   if (told_of_.is_due(topic)) ROS_WARN("%s ...", topic.c_str());
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

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

// One for each key. Keys are few: topics, reasons; never text of a message.
class WallThrottles {
 public:
  bool is_due(const std::string& key) { return told_[key].is_due(); }

 private:
  std::map<std::string, WallThrottle> told_;
};

}  // namespace prf_ros
