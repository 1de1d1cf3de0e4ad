// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/disturbances.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <stdexcept>

#include "motion/draws.hpp"
#include "motion/named_level.hpp"

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::uint64_t kStream = 0x6469737475726200;  // keeps these draws apart from others
constexpr double kEarliest = 3.0, kLatest = 9.0;       // s, of a time that is not given
constexpr double kLongestTime = 86400.0;               // s
constexpr double kStumbleDuration = 0.2;               // s
constexpr double kPeakOfLeastJerk = 1.875;             // largest over mean velocity of CartPush
constexpr std::size_t kMost = 20;

const std::string kHand = "hand";
const std::string kBody = "body";
const char* const kToes[] = {"fl_toe", "fr_toe", "rl_toe", "rr_toe"};

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(",+", begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

// Text of a number without zeros at its end, as it is asked for.
std::string plain(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

std::string names() {
  std::string text;
  for (const Disturbances::Kind& kind : Disturbances::kinds())
    text += (text.empty() ? "" : ", ") + std::string(kind.name);
  return text;
}

const Disturbances::Kind& kind_of(const std::string& word, const std::string& name) {
  for (const Disturbances::Kind& kind : Disturbances::kinds())
    if (kind.name == name) return kind;
  throw std::invalid_argument("disturb is " + prf_core::quoted(word) +
                              ", must be NAME:LEVEL or NAME:LEVEL@TIME with NAME one of " +
                              names());
}

}  // namespace

const std::vector<Disturbances::Kind>& Disturbances::kinds() {
  static const std::vector<Kind> all{{"push", 200.0},  {"push_hand", 200.0}, {"push_body", 200.0},
                                     {"stumble", 5.0}, {"cart", 0.4},        {"cart_toward", 0.4}};
  return all;
}

Disturbances::Disturbances(const std::string& text, std::uint64_t seed) {
  if (text.empty()) return;
  const std::vector<std::string> words = words_of(text);
  prf_core::require(words.size() <= kMost, "disturbances", words.size(),
                    "at most " + std::to_string(kMost));
  Draws draws(seed, kStream);
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find(':'));
    const Kind& kind = kind_of(word, name);
    const auto asked = named_level_of(word);
    if (!asked) (void)kind_of(word, "");
    prf_core::require_between("level of " + name, asked->level, 0.0, kind.highest);
    const double drawn = draws.uniform(kEarliest, kLatest);
    const double begin = asked->time.value_or(drawn);
    prf_core::require_between("time of " + name, begin, 0.0, kLongestTime, "s");
    const std::string told = name + ":" + plain(asked->level) + "@" + plain(begin);
    if (name.rfind("cart", 0) == 0) {
      add_push(name, told, asked->level, begin, draws);
    } else {
      add_force(name, told, asked->level, begin, draws);
    }
  }
}

void Disturbances::add_force(const std::string& name, const std::string& word, double level,
                             double begin, Draws& draws) {
  const double heading = draws.uniform(-kPi, kPi), rise = draws.uniform(-kPi / 6.0, kPi / 6.0);
  const double choice = draws.uniform(0.0, 1.0), length = draws.uniform(0.2, 0.5);
  Force force;
  force.word = word;
  force.begin = begin;
  if (name == "stumble") {
    force.link = kToes[static_cast<std::size_t>(4.0 * choice)];
    force.unit = Unit::kFootHold;
    force.duration = kStumbleDuration;
    force.peak = level * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
  } else {
    const bool on_hand = name == "push_hand" || (name == "push" && choice < 0.5);
    force.link = on_hand ? kHand : kBody;
    force.duration = length;
    force.peak = level * Eigen::Vector3d(std::cos(rise) * std::cos(heading),
                                         std::cos(rise) * std::sin(heading), std::sin(rise));
  }
  forces_.push_back(force);
}

void Disturbances::add_push(const std::string& name, const std::string& word, double level,
                            double begin, Draws& draws) {
  const double side = draws.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
  const double off = draws.uniform(-kPi / 6.0, kPi / 6.0);
  const double fastest = draws.uniform(0.75, 1.5);  // m/s per m
  CartPush::Params push;
  push.start = begin;
  push.duration = kPeakOfLeastJerk / fastest;
  push.distance = level;
  push.heading = (name == "cart_toward" ? kPi : side * kPi / 2.0) + off;
  pushes_.push_back({word, CartPush(push)});
}

double Disturbances::share(const Force& force, double time) {
  const double u = (time - force.begin) / force.duration;
  if (!(u > 0.0 && u < 1.0)) return 0.0;
  const double sine = std::sin(kPi * u);
  return sine * sine;
}

FrameState Disturbances::cart(double time) const {
  FrameState sum;
  for (const Push& push : pushes_) {
    const FrameState one = push.path.cart(time);
    sum.pose.translation() += one.pose.translation();
    sum.linear += one.linear;
  }
  return sum;
}

std::vector<Disturbances::Acting> Disturbances::acting(double time) const {
  std::vector<Acting> found;
  char what[120];
  for (const Force& force : forces_) {
    if (share(force, time) <= 0.0) continue;
    const char* unit = force.unit == Unit::kNewton ? "N" : "times its hold";
    const double heading = std::atan2(force.peak.y(), force.peak.x()) * 180.0 / kPi;
    std::snprintf(what, sizeof(what), "%.3g %s on %s, heading %.0f deg", force.peak.norm(), unit,
                  force.link.c_str(), heading);
    found.push_back({force.word, what});
  }
  for (const Push& push : pushes_) {
    const CartPush::Params& path = push.path.params();
    if (time < path.start || time > path.start + path.duration) continue;
    std::snprintf(what, sizeof(what), "%.2f m, at most %.2f m/s, heading %.0f deg", path.distance,
                  kPeakOfLeastJerk * path.distance / path.duration, path.heading * 180.0 / kPi);
    found.push_back({push.word, what});
  }
  return found;
}

}  // namespace platform_sim
