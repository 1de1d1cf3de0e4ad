// SPDX-License-Identifier: BSD-3-Clause
// Which responses the simulator waits for before it advances.
//
// The nodes form a chain. Each responds to the message before it with the same stamp:
//   camera/image_raw -> tag_detections -> target/forecast -> execution/progress ->
//   skill/trajectory -> execution/setpoint -> joint_command
// The rules of what is then pending: an image calls for detections, and detections call for a
// forecast. joint_states calls for progress, set-point and command of its stamp; a progress that
// names a new forecast calls for a skill trajectory. While a hand guides the arm, joint_states
// calls for guide/wrench only. When the simulator stands still, the pending response with the
// oldest stamp is the cause; among equal stamps, the one that comes first in the chain.
// The simulator can go on without a response that does not come (go_on()), as a real robot would:
// in the first ticks, which nodes that have been running before drop until they are sure that the
// clock went back, and when it injects faults. A topic given up in this way is waited for again as
// soon as it is heard, or when the simulator insists.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <prf_core/time.hpp>
#include <vector>

namespace platform_sim {

enum class Response {
  kDetections,
  kForecast,
  kProgress,
  kTrajectory,
  kSetpoint,
  kCommand,
  kDriver,
  kWrench
};
inline constexpr std::size_t kResponseCount = 8;

const char* topic_name(Response response);

enum class Peer { kFramework, kGuide };  // who moves the arm: the framework, or a guiding hand

struct SilentTopic {
  Response response;
  prf_core::Stamp stamp;  // of the pending response
};

enum class Receipt {
  kTaken,
  kNotNewer,  // late, or doubled
  kAhead,     // nothing of this stamp or a later one has been published: no response
};

class Lockstep {
 public:
  // `with_driver`: the arm is moved by messages to its driver, one for each joint_command. They
  // have no stamp: the caller gives them that of the tick in which they come.
  explicit Lockstep(Peer peer, bool with_driver = false) : peer_(peer), with_driver_(with_driver) {}

  // What the simulator published.
  void published_image(prf_core::Stamp exposure);
  void published_joint_states(prf_core::Stamp tick);

  // What came back. If taken it settles every pending response of its topic with the same or an
  // older stamp, else it is without effect.
  Receipt received(Response response, prf_core::Stamp stamp);
  // A forecast_stamp ahead of everything published names no forecast.
  Receipt received_progress(prf_core::Stamp stamp, prf_core::Stamp forecast_stamp);

  // Whether the simulator may advance: no progress, command, message to the
  // driver or wrench is pending. The other
  // responses are not waited for; they only serve first_silent().
  [[nodiscard]] bool is_complete() const;

  // Gives up the topics that is_complete() waits for. Returns them.
  std::vector<Response> go_on();
  // Waits again for what was given up.
  void insist();
  // Whether a topic is given up, and not yet heard again.
  [[nodiscard]] bool goes_without() const;

  // The response that has been pending for longest; none when nothing is pending.
  [[nodiscard]] std::optional<SilentTopic> first_silent() const;

 private:
  struct Expected {
    std::optional<prf_core::Stamp> last_received;
    std::deque<prf_core::Stamp> pending;  // rising
    bool given_up = false;
  };

  void published(prf_core::Stamp stamp);
  [[nodiscard]] bool is_ahead(prf_core::Stamp stamp) const;
  void expect(Response response, prf_core::Stamp stamp);
  Expected& expected(Response response) { return expected_[static_cast<std::size_t>(response)]; }
  [[nodiscard]] bool is_waited_for(Response response) const;
  const Expected& expected(Response response) const {
    return expected_[static_cast<std::size_t>(response)];
  }

  Peer peer_;
  bool with_driver_;
  std::array<Expected, kResponseCount> expected_;
  std::optional<prf_core::Stamp> newest_;  // that was published
  std::optional<prf_core::Stamp> forecast_in_force_;
};

}  // namespace platform_sim
