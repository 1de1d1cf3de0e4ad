// SPDX-License-Identifier: BSD-3-Clause
// Whether a person lets the arm move: dead-man's switch, hold, stop. Times are of a clock that
// never goes back, in s.
//
//   enable   must be true and come again within `enable_timeout`; only if `dead_man`
//   hold     on until it is taken off
//   stop     on until reset(); the driver's own stop goes with it
//   checked  the bring-up check has found nothing red; only if `needs_check`
#pragma once

#include <optional>
#include <string>

namespace prf_drivers {

struct OperatorParams {
  bool dead_man = false;
  double enable_timeout = 0.0;  // s, 0.02 to 2
  bool needs_check = false;

  // Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

class OperatorGate {
 public:
  explicit OperatorGate(const OperatorParams& params);

  void enable(bool pressed, double now);
  void hold(bool on) { hold_ = on; }
  void stop() { stopped_ = true; }
  void reset() { stopped_ = false; }
  // Empty: nothing is red; else what is.
  void checked(const std::string& red) { red_ = red; }

  // Why the arm must not move now; empty: it may.
  [[nodiscard]] std::string veto(double now) const;
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  OperatorParams params_;
  std::optional<double> pressed_;  // when the switch was last told to be pressed
  bool hold_ = false;
  bool stopped_ = false;
  std::optional<std::string> red_;
};

}  // namespace prf_drivers
