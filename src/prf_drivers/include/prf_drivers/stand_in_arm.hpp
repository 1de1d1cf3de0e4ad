// SPDX-License-Identifier: BSD-3-Clause
// An arm that is not there: it does what the commands say while the real one stands, or is moved by
// somebody else. So the framework can be rehearsed with the real camera and the real target.
//
// At the stamp t it is where the command of t - delay sent it, at no more than the velocity limits.
// Before the first command, and with a new run, it is where the real arm is.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <prf_core/clock_monitor.hpp>
#include <prf_core/time.hpp>

namespace prf_drivers {

struct StandInParams {
  double delay = 0.0;            // s, 0 to 0.5, from a command to the motion that it causes
  Eigen::VectorXd max_velocity;  // rad/s, > 0; its size is the number of joints

  // Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

struct StandInState {
  Eigen::VectorXd position;  // rad
  Eigen::VectorXd velocity;  // rad/s
};

class StandInArm {
 public:
  explicit StandInArm(const StandInParams& params);

  // At the tick of a measurement of the real arm, rad; none when its stamp cannot be used, or
  // neither arm is known.
  std::optional<StandInState> at(prf_core::Stamp stamp, const Eigen::VectorXd& measured);

  // Positions, rad. Whether the command is taken: not one that is not finite, of another size, or
  // not newer than the one before.
  bool command(prf_core::Stamp stamp, const Eigen::VectorXd& position);

 private:
  struct Commanded {
    prf_core::Stamp stamp;
    Eigen::VectorXd position;
  };
  [[nodiscard]] Eigen::VectorXd commanded_at(prf_core::Stamp stamp) const;

  StandInParams params_;
  prf_core::ClockMonitor clock_;
  std::deque<Commanded> commands_;  // rising
  std::optional<prf_core::Stamp> last_;
  std::optional<Eigen::VectorXd> position_;
};

}  // namespace prf_drivers
