// SPDX-License-Identifier: BSD-3-Clause
// From the framework's joint commands to what an arm's driver is sent: one of these for each
// control tick.
//
// A driver for velocities gets
//   v(t) = dq(t) + gain (q(t - delay) - measured(t)),
// clamped to the velocity limits; q and dq are the commanded positions and velocities. `delay` is
// the time from a command to the motion that it causes: the arm is compared with what it could know
// so far, so that a driver's latency is not mistaken for an error. Without disturbances the arm
// follows q exactly, `delay` late; gain * delay < 0.5 keeps the loop well damped.
// A driver for positions gets q(t), moved from what was sent before at no more than the velocity
// limits.
//
// The arm is braked to rest (`braking`) and then held when the commands stop coming, when one
// cannot be used or lies farther than `max_distance` from the measured joints, when these are not
// known, and when the operator or a guard does not allow motion: velocities become 0, positions
// stay where the braking has ended. No command that is not finite can leave.
//
// With a speed below 1, of the operator or of a guard, all joints are slowed down alike until none
// is faster than that share of its limit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <prf_core/stream_joiner.hpp>
#include <prf_core/time.hpp>
#include <string>
#include <vector>

#include "prf_drivers/motion_guard.hpp"

namespace prf_drivers {

enum class Takes { kVelocities, kPositions };

struct AdapterParams {
  Takes takes = Takes::kVelocities;
  double period = 0.0;           // s, of the control ticks, 0.001 to 0.1
  double delay = 0.0;            // s, 0 to 0.5; not used for positions
  double gain = 0.0;             // 1/s, 0 to 50; not used for positions
  double command_timeout = 0.0;  // s, 0.01 to 1; then the commands count as silent
  double max_distance = 0.0;     // rad, 0.01 to 1; of a command from the measured joints
  double braking = 0.0;          // rad/s^2, 0.1 to 100
  Eigen::VectorXd max_velocity;  // rad/s, > 0; its size is the number of joints

  // Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

struct DriverCommand {
  prf_core::Stamp stamp{0};  // of the tick
  Eigen::VectorXd position;  // rad; for a driver of velocities the commanded ones, for the record
  Eigen::VectorXd velocity;  // rad/s
  std::string hold;          // why the arm is held; empty: it follows
  MotionCode code = MotionCode::kFollows;
  double speed = 1.0;  // share of the velocity limits that is allowed
  std::string slowed;  // why a guard allows no more; empty: none does
};

struct AdapterCounts {
  unsigned long ticks = 0;
  unsigned long held = 0;              // ticks
  unsigned long refused_commands = 0;  // unusable, or too far from the measured joints
  unsigned long late_commands = 0;
  unsigned long new_runs = 0;
};

class CommandAdapter {
 public:
  // Without guards nothing but the rules above keeps the arm from moving.
  explicit CommandAdapter(const AdapterParams& params,
                          std::shared_ptr<MotionGuard> guards = nullptr);

  // Measured at a control tick. The results are those of the ticks that are decided now, in order;
  // none before the first command of a run.
  std::vector<DriverCommand> add_measured(prf_core::Stamp stamp, const Measured& measured);
  // The command of a tick: positions, rad, and velocities, rad/s. An empty vector stands for a
  // command that cannot be used, with the reason.
  std::vector<DriverCommand> add_command(prf_core::Stamp stamp, const Eigen::VectorXd& position,
                                         const Eigen::VectorXd& velocity,
                                         const std::string& refusal = "");

  // While ticks fail to come: brakes and holds for another period. None before the first command.
  std::optional<DriverCommand> hold(const std::string& why);

  // Why the operator does not allow motion; empty: motion is allowed.
  void set_veto(const std::string& veto) { veto_ = veto; }
  // Share of the velocity limits, 0 (the arm is held) to 1, from the next tick on. Throws
  // std::invalid_argument beyond these bounds.
  void set_speed(double speed);

  [[nodiscard]] const AdapterCounts& counts() const { return counts_; }

 private:
  struct Command {
    Eigen::VectorXd position;
    Eigen::VectorXd velocity;
    std::string refusal;
  };
  struct Commanded {
    prf_core::Stamp stamp;
    Eigen::VectorXd position;
  };
  using Joiner = prf_core::StreamJoiner<Measured, Command>;

  std::vector<DriverCommand> decided();
  std::optional<DriverCommand> process(const Joiner::Joined& tick);
  [[nodiscard]] std::string reason_to_hold(const Joiner::Joined& tick) const;
  [[nodiscard]] double distance(const Eigen::VectorXd& commanded,
                                const Eigen::VectorXd& measured) const;
  // Commanded position `delay` before the stamp.
  [[nodiscard]] Eigen::VectorXd expected_at(prf_core::Stamp stamp) const;
  struct Motion {
    Eigen::VectorXd position;
    Eigen::VectorXd velocity;
  };
  // Follows, unless a guard holds. Nothing is kept of a motion that is not sent.
  [[nodiscard]] DriverCommand follow(const Command& command, const Measured& measured,
                                     prf_core::Stamp stamp);
  [[nodiscard]] Motion motion(const Command& command, const Eigen::VectorXd& measured,
                              prf_core::Stamp stamp, double speed) const;
  // Where the arm comes to rest when it is braked after this motion.
  [[nodiscard]] Eigen::VectorXd rest_after(const Motion& motion,
                                           const Eigen::VectorXd& measured) const;
  void brake();
  void remember(prf_core::Stamp stamp, const Eigen::VectorXd& position);

  AdapterParams params_;
  std::shared_ptr<MotionGuard> guards_;
  double speed_ = 1.0;  // that the operator allows
  Joiner joiner_;
  std::deque<Commanded> history_;  // of the last `delay`, rising
  bool begun_ = false;             // a command has been followed
  Eigen::VectorXd position_;       // sent last
  Eigen::VectorXd velocity_;
  std::string veto_;
  AdapterCounts counts_;
};

}  // namespace prf_drivers
