// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/demonstration_limits.hpp"

#include <prf_core/require.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

namespace elte_planner {
namespace {

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text.precision(4);
  text << "demonstration: ";
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

const char* hint(double value, double limit, const char* unit) {
  return value / 1000.0 <= limit ? unit : "";
}

void check_place(const std::string& what, double distance, double limit) {
  if (distance <= limit) return;
  refuse(what, " is ", distance, " m from the origin of the planning frame, must be at most ",
         limit, " m", hint(distance, limit, "; is it in mm?"));
}

void check_step(std::size_t row, const TimedPose& before, const TimedPose& sample,
                const DemonstrationLimits& limits) {
  const double time = sample.time - before.time;
  const double distance = (sample.pose.position - before.pose.position).norm();
  const double angle = before.pose.orientation.angularDistance(sample.pose.orientation);
  if (!(distance <= limits.gap)) {
    refuse("row ", row, " is ", distance, " m from the row before, must be at most ", limits.gap,
           " m: rows are missing or one is wild");
  }
  if (!(distance <= limits.speed * time)) {
    refuse("row ", row, " moves by ", distance, " m in ", time, " s = ", distance / time,
           " m/s, must be at most ", limits.speed, " m/s: the row is wild or the times are wrong");
  }
  if (!(angle <= limits.turning_rate * time)) {
    refuse("row ", row, " turns by ", angle, " rad in ", time, " s = ", angle / time,
           " rad/s, must be at most ", limits.turning_rate,
           " rad/s: the row is wild or the times are wrong");
  }
}

}  // namespace

void DemonstrationLimits::validate() const {
  using prf_core::require_between;
  require_between("reach", reach, 0.1, 10.0, "m");
  require_between("speed", speed, 0.01, 10.0, "m/s");
  require_between("turning_rate", turning_rate, 0.1, 100.0, "rad/s");
  require_between("gap", gap, 0.001, 10.0, "m");
  require_between("duration", duration, 0.1, 3600.0, "s");
  require_between("target", target, 0.1, 100.0, "m");
}

void require_executable(const Demonstration& demonstration, const DemonstrationLimits& limits) {
  const auto& samples = demonstration.samples();
  check_place("target_pose", demonstration.target().position.norm(), limits.target);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t row = i + 1;
    check_place("row " + std::to_string(row), samples[i].pose.position.norm(), limits.reach);
    if (i > 0) check_step(row, samples[i - 1], samples[i], limits);
  }
  const double duration = samples.back().time;
  if (!(duration <= limits.duration)) {
    refuse("row ", samples.size(), " has time ", duration, " s, must be at most ", limits.duration,
           " s", hint(duration, limits.duration, "; is it in ms?"));
  }
}

}  // namespace elte_planner
