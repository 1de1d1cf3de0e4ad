// SPDX-License-Identifier: BSD-3-Clause
// Physical bounds for numbers that come from outside: messages, files, parameters. They lie far
// beyond whatever an arm on a robot can meet, and near enough that squares, products and sums of
// what they admit are finite and meaningful. Not-a-number is within no bound.
#pragma once

#include <Eigen/Core>
#include <string>

#include "prf_core/require.hpp"
#include "prf_core/time.hpp"

namespace prf_core {

inline constexpr double kMaxPosition = 1e4;       // m, of each coordinate
inline constexpr double kMaxSpeed = 1e3;          // m/s, of each coordinate
inline constexpr double kMaxAngularSpeed = 1e3;   // rad/s
inline constexpr double kMaxAcceleration = 1e5;   // m/s^2 or rad/s^2
inline constexpr double kMaxJointPosition = 1e4;  // rad or m
inline constexpr double kMaxVariance = 1e8;       // m^2, (m/s)^2, rad^2: kMaxPosition squared
inline constexpr Duration kMaxHorizon = std::chrono::hours(1);

// ROS has 32 bits for the seconds. A stamp within these bounds, more or less an hour, is one that
// arithmetic on stamps cannot overflow, and at the upper end one that ros::Time can hold.
inline constexpr Stamp kMinStamp{0};
inline constexpr Stamp kMaxStamp = std::chrono::seconds(4'294'967'295) - std::chrono::hours(1);

[[nodiscard]] constexpr bool is_within(double value, double bound) {
  return value >= -bound && value <= bound;
}

template <typename Derived>
[[nodiscard]] bool is_within(const Eigen::MatrixBase<Derived>& values, double bound) {
  return (values.array().abs() <= bound).all();
}

[[nodiscard]] constexpr bool is_usable_stamp(Stamp stamp) {
  return stamp >= kMinStamp && stamp <= kMaxStamp;
}

// Each throws std::invalid_argument for a value that is not finite or beyond the bound.
template <typename Derived>
void require_within(const std::string& name, const Eigen::MatrixBase<Derived>& values, double bound,
                    const std::string& unit) {
  if (is_within(values, bound)) return;
  const bool is_vector = Derived::RowsAtCompileTime == 1 || Derived::ColsAtCompileTime == 1;
  std::ostringstream text;
  if (is_vector) {
    text << values.derived().reshaped().transpose();
  } else {
    text << values.cwiseAbs().maxCoeff() << " at most";
  }
  std::ostringstream must;
  must << "finite and within +-" << bound << " " << unit;
  require(false, name, text.str(), must.str());
}

inline void require_stamp(const std::string& name, Stamp stamp) {
  if (is_usable_stamp(stamp)) return;  // else at most one line for each refused message
  std::ostringstream must;
  must << "within [0, " << std::chrono::duration_cast<std::chrono::seconds>(kMaxStamp).count()
       << "] s";
  require(false, name, std::to_string(to_seconds(stamp)), must.str());
}

}  // namespace prf_core
