// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/tick_gate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>
#include <stdexcept>

#include "gate_world.hpp"

namespace prf_decision {
namespace {

bool names_a_forecast(const Tick& tick) {
  for (const auto& arrival : tick.forecasts) {
    if (arrival.forecast) return true;
  }
  return false;
}

struct Sequences {
  std::vector<Stamp> ticks;
  std::vector<Stamp> forecasts;
};

// 1.5 s of ticks at 100 Hz, images at 30 Hz with jitter; up to 5 images in a row are missing.
Sequences random_sequences(std::mt19937& random) {
  Sequences sequences;
  const Stamp start = std::chrono::seconds(100);
  for (int i = 0; i < 150; ++i) sequences.ticks.push_back(start + i * kTickPeriod);
  std::uniform_int_distribution<int> jitter(-4000, 4000);
  std::bernoulli_distribution drop(0.2);
  int dropped = 0;
  for (int i = 0; i < 48; ++i) {
    const bool missing = i > 0 && i < 47 && dropped < 5 && drop(random);
    dropped = missing ? dropped + 1 : 0;
    if (missing) continue;
    const Duration late = std::chrono::microseconds(i == 0 ? 0 : jitter(random));
    sequences.forecasts.push_back(start + from_seconds(i / 30.0) + late);
  }
  return sequences;
}

// Delivers the streams in a random order that respects each stream's own; a plan result can only
// come after its progress. Ticks run ahead of what they wait for by less than max_wait.
std::string deliver(const Sequences& sequences, std::mt19937& random) {
  TickGate gate(kGate);
  std::string processed;
  std::deque<Stamp> requests;
  std::deque<Stamp> reports;
  std::size_t ticks = 0;
  std::size_t forecasts = 0;
  Stamp waiting_since = sequences.ticks[0];
  std::discrete_distribution<int> bias({1, 1, 1, 1});
  for (;;) {
    const bool may_tick =
        ticks < sequences.ticks.size() && sequences.ticks[ticks] - waiting_since <= kGate.max_wait;
    const bool may_forecast = forecasts < sequences.forecasts.size() &&
                              (ticks == 0 || sequences.forecasts[forecasts] <
                                                 sequences.ticks[ticks - 1] + milliseconds(900));
    if (!may_tick && !may_forecast && requests.empty() && reports.empty()) break;
    switch (bias(random)) {
      case 0:
        if (may_tick) gate.push_tick(sequences.ticks[ticks++]);
        break;
      case 1:
        if (may_forecast) gate.push_forecast(forecast(sequences.forecasts[forecasts++]));
        break;
      case 2:
        if (!reports.empty()) {
          gate.push_control_report(report(reports.front()));
          reports.pop_front();
        }
        break;
      default:
        if (!requests.empty()) {
          gate.push_plan_result(plan_result(requests.front()));
          requests.pop_front();
        }
    }
    // Now and then the order is biased, so that one stream runs far ahead.
    if (random() % 20 == 0) {
      const double a = static_cast<double>(1 + random() % 20);
      const double b = static_cast<double>(1 + random() % 20);
      bias = std::discrete_distribution<int>({a, b, 1, 1});
    }
    while (const auto tick = gate.next()) {
      const auto& control = tick->control;
      processed += (control ? std::to_string(control->stamp.count()) : "") + " " + describe(*tick);
      reports.push_back(tick->stamp);
      if (names_a_forecast(*tick)) requests.push_back(tick->stamp);
      waiting_since = tick->stamp + kTickPeriod;
    }
  }
  EXPECT_EQ(ticks, sequences.ticks.size());
  return processed;
}

TEST(TickGate, ProcessesTheSameSequenceWhateverTheInterleaving) {
  std::mt19937 random(1);
  for (int world = 0; world < 100; ++world) {
    const Sequences sequences = random_sequences(random);
    const std::string expected = deliver(sequences, random);
    EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 150);
    EXPECT_EQ(expected.find("silent"), std::string::npos);
    for (int order = 0; order < 60; ++order) {
      ASSERT_EQ(deliver(sequences, random), expected) << "world " << world << " order " << order;
    }
  }
}

TEST(TickGate, UsesAForecastFromTheFirstTickAfterThePipelineDelay) {
  TickGate gate(kGate);
  EXPECT_EQ(lines(tick_through(gate, 0, 7)), 6);  // the tick at 60 ms could see an image of 0 ms
  gate.push_forecast(forecast(Stamp{0}));
  EXPECT_EQ(describe(*gate.next()), "60000000: f0\n");
  EXPECT_FALSE(gate.next());
}

TEST(TickGate, WaitsForTheResultOfTheProgressThatNamedAForecast) {
  TickGate gate(kGate);
  gate.push_forecast(forecast(Stamp{0}));
  EXPECT_EQ(lines(tick_through(gate, 0, 8)), 7);
  gate.push_plan_result(plan_result(milliseconds(60)));
  EXPECT_EQ(describe(*gate.next()), "70000000: a60000000\n");
}

TEST(TickGate, DoesNotExpectAResultForARefusedForecast) {
  TickGate gate(kGate);
  gate.push_forecast({Stamp{0}, nullptr});
  EXPECT_EQ(lines(tick_through(gate, 0, 9)), 9);
}

TEST(TickGate, GivesUpOnASilentForecastByDataTimeAndWaitsAgainOnceItIsHeard) {
  TickGate gate(kGate);
  EXPECT_EQ(lines(tick_through(gate, 0, 37)), 6);  // newest 360 ms, waiting 60 ms: not yet
  const std::string late = tick_through(gate, 37, 40);
  EXPECT_EQ(late.rfind("60000000: forecast_silent\n", 0), 0u);
  EXPECT_EQ(lines(late), 34);
  gate.push_forecast(forecast(milliseconds(330)));
  EXPECT_EQ(tick_through(gate, 40, 41), "400000000: f330000000\n");
}

TEST(TickGate, GivesUpOnASilentPlannerAndWaitsAgainOnceItIsHeard) {
  TickGate gate(kGate);
  gate.push_forecast(forecast(Stamp{0}));
  EXPECT_EQ(lines(tick_through(gate, 0, 38)), 7);
  for (int i = 1; i < 12; ++i) gate.push_forecast(forecast(from_seconds(i / 30.0)));
  const std::string late = tick_through(gate, 38, 39);
  EXPECT_EQ(late.rfind("70000000: planner_silent\n", 0), 0u);
  EXPECT_EQ(lines(late), 32);
  gate.push_plan_result(plan_result(milliseconds(60)));
  EXPECT_EQ(tick_through(gate, 39, 40), "");  // waits for the results still due
  gate.push_plan_result(plan_result(milliseconds(370)));
  EXPECT_EQ(describe(*gate.next()), "390000000: a370000000\n");
}

TEST(TickGate, UsesTheReportOnATickAfterTheControlDelayAndWaitsForIt) {
  TickGate gate(kGate);
  int processed = 0;
  for (int i = 0; i < 6; ++i) {
    gate.push_tick(i * kTickPeriod);
    while (const auto tick = gate.next()) {
      EXPECT_FALSE(tick->control);
      ++processed;
    }
  }
  EXPECT_EQ(processed, 5);  // that of 50 ms waits for the report on the first
  gate.push_control_report({Stamp{0}, true, "stalled"});
  const auto tick = gate.next();
  ASSERT_TRUE(tick && tick->control);
  EXPECT_TRUE(tick->control->failing);
  EXPECT_EQ(tick->control->reason, "stalled");
}

// Fault 38: controller dead -> its reports are silent by data time, heard again once it is back
TEST(TickGate, GivesUpOnASilentControllerAndWaitsAgainOnceItIsHeard) {
  TickGate gate(kGate);
  gate.push_forecast({Stamp{0}, nullptr});
  const auto tick_alone = [&gate](int i) {
    std::string text;
    gate.push_tick(i * kTickPeriod);
    while (const auto tick = gate.next()) text += describe(*tick);
    return text;
  };
  std::string text;
  for (int i = 0; i < 36; ++i) text += tick_alone(i);
  EXPECT_EQ(lines(text), 5);
  for (int i = 4; i < 12; ++i) gate.push_forecast({from_seconds(i / 30.0), nullptr});
  EXPECT_EQ(tick_alone(36).rfind("50000000: control_silent\n", 0), 0u);
  gate.push_control_report(report(milliseconds(320)));
  EXPECT_EQ(tick_alone(37).find("silent"), std::string::npos);
}

// Fault 40: a tick, forecast, result or report stamped 0.3 s early -> it alone is dropped
TEST(TickGate, DropsSingleEarlyStampsOfEveryStream) {
  TickGate gate(kGate);
  const Stamp early = milliseconds(300);
  std::string processed;
  for (int i = 0; i < 200; ++i) {
    const Stamp tick = i * kTickPeriod;
    EXPECT_EQ(gate.push_tick(tick), PushResult::kAccepted);
    if (i % 3 == 0) {
      EXPECT_EQ(gate.push_forecast(forecast(tick)), PushResult::kAccepted);
    }
    if (i == 100) {
      EXPECT_EQ(gate.push_tick(tick + early), PushResult::kFarAhead);
      EXPECT_EQ(gate.push_forecast(forecast(tick + early)), PushResult::kFarAhead);
      EXPECT_EQ(gate.push_plan_result(plan_result(tick + early)), PushResult::kFarAhead);
      EXPECT_EQ(gate.push_control_report(report(tick + early)), PushResult::kFarAhead);
    }
    while (const auto next = gate.next()) {
      processed += describe(*next);
      EXPECT_EQ(gate.push_control_report(report(next->stamp)), PushResult::kAccepted);
      if (next->forecasts.empty()) continue;
      EXPECT_EQ(gate.push_plan_result(plan_result(next->stamp)), PushResult::kAccepted);
    }
  }
  EXPECT_EQ(lines(processed), 200);
  EXPECT_EQ(processed.find("silent"), std::string::npos);
}

}  // namespace
}  // namespace prf_decision
