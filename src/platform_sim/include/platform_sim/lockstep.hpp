// SPDX-License-Identifier: BSD-3-Clause
// Who owes an answer to the simulator.
//
// The chain, each link answering its predecessor with the predecessor's stamp:
//   camera/image_raw -> tag_detections -> target/forecast -> execution/progress ->
//   skill/trajectory -> execution/setpoint -> joint_command
// joint_states asks for progress, set-point and command of the same stamp; a progress that names a
// new forecast asks for a skill trajectory. While a hand guides the arm,
// joint_states asks for guide/wrench only.
// Of all answers still owed the one with the oldest stamp is the cause of a standstill, among equal
// stamps the one that comes first in the chain.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace platform_sim {

using StampNs = std::int64_t;  // simulation time, ns

enum class Link { kDetections, kForecast, kProgress, kTrajectory, kSetpoint, kCommand, kWrench };
inline constexpr std::size_t kLinkCount = 7;

const char* topic_name(Link link);  // relative name of the topic that carries the answers

enum class Peer { kFramework, kGuide };  // who moves the arm: the framework, or a guiding hand

struct SilentTopic {
  Link link;
  StampNs stamp;  // of the answer waited for
};

class Lockstep {
 public:
  explicit Lockstep(Peer peer) : peer_(peer) {}

  // What the simulator published.
  void published_image(StampNs exposure);
  void published_joint_states(StampNs tick);

  // What came back. False, and without effect, if it is not newer than what came before.
  bool received(Link link, StampNs stamp);
  bool received_progress(StampNs stamp, StampNs forecast_stamp);

  // True when everything the simulator needs to go on from the last joint_states is there.
  [[nodiscard]] bool answered() const;

  // The answer owed for longest; none when nothing is owed.
  [[nodiscard]] std::optional<SilentTopic> first_silent() const;

 private:
  struct Account {
    std::optional<StampNs> last_received;
    std::deque<StampNs> owed;  // rising
  };

  void ask(Link link, StampNs stamp);
  Account& account(Link link) { return accounts_[static_cast<std::size_t>(link)]; }
  const Account& account(Link link) const { return accounts_[static_cast<std::size_t>(link)]; }

  Peer peer_;
  std::array<Account, kLinkCount> accounts_;
  std::optional<StampNs> forecast_in_force_;
};

}  // namespace platform_sim
