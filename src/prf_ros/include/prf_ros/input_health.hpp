// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with one input of a node: it is silent, too slow, refused, or sent by two
// publishers. It reports only; nothing here changes data. `now` is wall time: seconds on a clock
// that never goes back. Rates are those of the stamps, so that a simulator may run as slowly as it
// likes.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace prf_ros {

enum class Presence {
  kContinuous,  // silence is a fault
  kOnce,        // a fault until the first message has come, as of a latched topic
  kOnDemand     // silence is none
};

struct InputExpectation {
  std::string topic;
  std::string what;   // in words, as in "sensor_msgs/JointState with j2s7s300_joint_1 ... 7"
  double rate = 0.0;  // Hz, by the stamps; 0: any
  Presence presence = Presence::kContinuous;
  bool many_publishers = false;  // as of /tf
};

class InputHealth {
 public:
  enum class Level { kOk, kWarn, kError };
  struct Report {
    Level level = Level::kOk;
    std::string text;     // empty: nothing is wrong
    bool to_log = false;  // nothing else has logged it
  };

  static constexpr double kSilence = 5.0;   // s, without a message, or with none accepted
  static constexpr double kTogether = 1.0;  // s, within which two publishers count as two
  static constexpr double kShown = 5.0;     // s, for which a drop or a second publisher is reported

  InputHealth(InputExpectation expected, double now);

  // A message has come. `stamp` in s of data time; none: the type has no header. Returns a line to
  // log: a second publisher, at most once in kShown.
  std::string receive(const std::string& publisher, std::optional<double> stamp, double now);

  // The message received last is not used, with the reason. Returns a line to log, at most one each
  // second for each reason.
  std::string drop(const std::string& reason, double now);

  [[nodiscard]] Report report(double now) const;

  [[nodiscard]] const InputExpectation& expected() const { return expected_; }
  [[nodiscard]] std::uint64_t received() const { return received_; }
  // Hz, by the stamps of what was not dropped; none: not known yet.
  [[nodiscard]] std::optional<double> rate() const { return rate_; }
  [[nodiscard]] std::map<std::string, std::uint64_t> drops() const;  // by reason

 private:
  struct Drops {
    std::uint64_t count = 0;
    double last = 0.0;
    double logged = 0.0;
  };

  std::string note_publisher(const std::string& publisher, double now);
  void note_stamp(double stamp);
  [[nodiscard]] std::string expectation() const;

  InputExpectation expected_;
  double begin_;
  std::uint64_t received_ = 0;
  std::optional<double> last_received_;
  std::optional<double> last_accepted_;  // as far as is known: until a drop takes it back
  std::optional<double> accepted_before_;
  std::string publisher_;                // of the last message
  std::map<std::string, double> heard_;  // when each publisher was heard last
  std::string second_;                   // what to say of two publishers
  double second_seen_;
  double second_logged_;
  std::optional<double> pending_stamp_;  // of the last message, which may still be dropped
  std::optional<double> last_stamp_;
  std::vector<double> intervals_;  // s, between stamps, since the rate was found
  std::optional<double> rate_;
  std::string last_drop_;
  std::map<std::string, Drops> drops_;
};

}  // namespace prf_ros
