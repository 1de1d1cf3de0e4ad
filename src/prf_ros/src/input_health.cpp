// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/input_health.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <prf_core/quoted.hpp>
#include <utility>

namespace prf_ros {
namespace {

using prf_core::quoted;

constexpr double kNever = -1e9;     // s, a wall time long ago
constexpr double kLogPeriod = 1.0;  // s, of the same line
constexpr double kLongest = 10.0;   // s between stamps; more is a gap or a wrong stamp
constexpr std::size_t kIntervals = 20;
constexpr std::size_t kMaxNames = 20;  // of publishers and of reasons that are remembered

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

InputHealth::InputHealth(InputExpectation expected, double now)
    : expected_(std::move(expected)), begin_(now), second_seen_(kNever), second_logged_(kNever) {}

std::string InputHealth::receive(const std::string& publisher, std::optional<double> stamp,
                                 double now) {
  ++received_;
  last_received_ = now;
  accepted_before_ = last_accepted_;
  last_accepted_ = now;
  if (pending_stamp_) note_stamp(*pending_stamp_);
  pending_stamp_ = stamp;
  return expected_.many_publishers ? "" : note_publisher(publisher, now);
}

std::string InputHealth::note_publisher(const std::string& publisher, double now) {
  const bool same = received_ > 1 && publisher == publisher_;
  publisher_ = publisher;
  if (same && second_seen_ < now - kTogether) {
    heard_[publisher] = now;
    return "";
  }
  if (heard_.size() > kMaxNames) heard_.clear();
  heard_[publisher] = now;
  std::string others;
  for (const auto& [name, when] : heard_) {
    if (name == publisher || when < now - kTogether) continue;
    others += (others.empty() ? "" : ", ") + quoted(name);
  }
  if (others.empty()) return "";
  second_ = expected_.topic + " has two publishers, " + quoted(publisher) + " and " + others +
            "; expected is one";
  second_seen_ = now;
  if (now - second_logged_ < kShown) return "";
  second_logged_ = now;
  return second_;
}

void InputHealth::note_stamp(double stamp) {
  const double interval = last_stamp_ ? stamp - *last_stamp_ : 0.0;
  last_stamp_ = stamp;
  if (!(interval > 0.0 && interval < kLongest)) return;
  intervals_.push_back(interval);
  if (intervals_.size() < kIntervals) return;
  rate_ = 1.0 / median(std::exchange(intervals_, {}));
}

std::string InputHealth::drop(const std::string& reason, double now) {
  last_accepted_ = accepted_before_;
  pending_stamp_.reset();
  const bool known = drops_.count(reason) > 0 || drops_.size() < kMaxNames;
  const std::string kind = known ? reason : "other reasons";
  last_drop_ = reason;
  const auto [entry, is_new] = drops_.emplace(kind, Drops{0, now, kNever});
  Drops& drops = entry->second;
  ++drops.count;
  drops.last = now;
  if (now - drops.logged < kLogPeriod) return "";
  drops.logged = now;
  return expected_.topic + " dropped: " + reason + " (" + std::to_string(drops.count) +
         " so far); expected is " + expectation();
}

InputHealth::Report InputHealth::report(double now) const {
  const bool must_come = expected_.presence == Presence::kContinuous ||
                         (expected_.presence == Presence::kOnce && received_ == 0);
  const double silence = now - last_received_.value_or(begin_);
  if (must_come && silence >= kSilence) {
    const std::string since = received_ == 0 ? "" : " any more";
    return {Level::kError,
            "no message on " + expected_.topic + since + " for " + number(silence) +
                " s, expected is " + expectation(),
            true};
  }
  const double refused_for = now - last_accepted_.value_or(begin_);
  if (expected_.presence != Presence::kOnDemand && received_ > 0 && !last_drop_.empty() &&
      refused_for >= kSilence) {
    return {Level::kError,
            "every message on " + expected_.topic + " is dropped: " + last_drop_ +
                "; expected is " + expectation(),
            true};
  }
  Report report;
  const auto warn = [&report](const std::string& text, bool to_log) {
    report.level = Level::kWarn;
    report.text += (report.text.empty() ? "" : "; ") + text;
    report.to_log = report.to_log || to_log;
  };
  if (rate_ && *rate_ < 0.5 * expected_.rate) {
    warn(expected_.topic + " comes at " + number(*rate_) + " Hz by its stamps, expected is " +
             expectation(),
         true);
  }
  if (second_seen_ > now - kShown) warn(second_, false);
  for (const auto& [reason, drops] : drops_) {
    if (drops.last > now - kShown) warn(expected_.topic + " dropped: " + reason, false);
  }
  return report;
}

std::map<std::string, std::uint64_t> InputHealth::drops() const {
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [reason, drops] : drops_) counts[reason] = drops.count;
  return counts;
}

std::string InputHealth::expectation() const {
  return expected_.what + (expected_.rate > 0.0 ? " at " + number(expected_.rate) + " Hz" : "");
}

}  // namespace prf_ros
