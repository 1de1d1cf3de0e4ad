// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/tick_gate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>
#include <stdexcept>

#include "scenario.hpp"

namespace prf_decision {
namespace {

using std::chrono::milliseconds;

const GateParams kGate{milliseconds(60), from_seconds(1 / 30.0), milliseconds(300)};

ForecastArrival forecast(Stamp stamp) { return {stamp, std::make_shared<TargetForecast>()}; }

PlanResult plan_result(Stamp stamp) { return {stamp, std::make_shared<Trajectory>(), ""}; }

// Line per tick: its stamp, the forecasts and the plan result used from it on, what is silent.
std::string describe(const Tick& tick) {
  std::ostringstream line;
  line << tick.stamp.count() << ":";
  for (const auto& arrival : tick.forecasts) line << " f" << arrival.stamp.count();
  if (tick.plan_result) line << " a" << tick.plan_result->stamp.count();
  if (tick.forecast_silent) line << " forecast_silent";
  if (tick.planner_silent) line << " planner_silent";
  return line.str() + "\n";
}

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
  std::size_t ticks = 0;
  std::size_t forecasts = 0;
  Stamp waiting_since = sequences.ticks[0];
  std::discrete_distribution<int> bias({1, 1, 1});
  for (;;) {
    const bool may_tick =
        ticks < sequences.ticks.size() && sequences.ticks[ticks] - waiting_since <= kGate.max_wait;
    const bool may_forecast = forecasts < sequences.forecasts.size() &&
                              (ticks == 0 || sequences.forecasts[forecasts] <
                                                 sequences.ticks[ticks - 1] + milliseconds(900));
    if (!may_tick && !may_forecast && requests.empty()) break;
    switch (bias(random)) {
      case 0:
        if (may_tick) gate.push_tick(sequences.ticks[ticks++]);
        break;
      case 1:
        if (may_forecast) gate.push_forecast(forecast(sequences.forecasts[forecasts++]));
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
      bias = std::discrete_distribution<int>({a, b, 1});
    }
    while (const auto tick = gate.next()) {
      processed += describe(*tick);
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

// Pushes ticks 0 .. count-1 and gives back what was processed.
std::string tick_through(TickGate& gate, int from, int to) {
  std::string processed;
  for (int i = from; i < to; ++i) {
    gate.push_tick(i * kTickPeriod);
    while (const auto tick = gate.next()) processed += describe(*tick);
  }
  return processed;
}

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

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

TEST(TickGate, DropsDuplicatesAndStampsFarAhead) {
  TickGate gate(kGate);
  EXPECT_EQ(gate.push_tick(Stamp{0}), PushResult::kAccepted);
  EXPECT_EQ(gate.push_tick(Stamp{0}), PushResult::kOld);
  EXPECT_EQ(gate.push_forecast(forecast(milliseconds(30))), PushResult::kAccepted);
  EXPECT_EQ(gate.push_forecast(forecast(milliseconds(30))), PushResult::kOld);
  EXPECT_EQ(gate.push_forecast(forecast(milliseconds(10))), PushResult::kOld);
  EXPECT_EQ(gate.push_forecast(forecast(milliseconds(1001))), PushResult::kFarAhead);
  EXPECT_EQ(gate.push_plan_result(plan_result(Stamp{0})), PushResult::kAccepted);
  EXPECT_EQ(gate.push_plan_result(plan_result(Stamp{0})), PushResult::kOld);
  EXPECT_EQ(gate.push_plan_result(plan_result(milliseconds(1001))), PushResult::kFarAhead);
}

TEST(TickGate, DropsEverythingWhenTheTicksGoBack) {
  TickGate gate(kGate);
  gate.push_forecast(forecast(Stamp{0}));
  tick_through(gate, 0, 8);
  gate.push_tick(milliseconds(1000));
  gate.push_tick(milliseconds(2000));
  TickGate fresh(kGate);
  for (const int ms : {40, 50}) EXPECT_EQ(gate.push_tick(milliseconds(ms)), PushResult::kOld);
  EXPECT_EQ(gate.push_tick(milliseconds(60)), PushResult::kNewRun);
  fresh.push_tick(milliseconds(60));
  EXPECT_EQ(describe(*gate.next()), describe(*fresh.next()));
  EXPECT_EQ(gate.push_forecast(forecast(milliseconds(60))), PushResult::kAccepted);
  EXPECT_EQ(gate.push_plan_result(plan_result(Stamp{0})), PushResult::kOld);
  EXPECT_EQ(gate.push_plan_result(plan_result(milliseconds(60))), PushResult::kAccepted);
}

TEST(TickGate, DropsForecastsThatGoBackAndStaysInItsRun) {
  TickGate gate(kGate);
  gate.push_tick(std::chrono::seconds(5));
  EXPECT_EQ(gate.push_forecast(forecast(std::chrono::seconds(5))), PushResult::kAccepted);
  for (const int ms : {400, 433, 466, 500}) {
    EXPECT_EQ(gate.push_forecast(forecast(milliseconds(ms))), PushResult::kOld);
  }
  EXPECT_EQ(gate.push_tick(milliseconds(5010)), PushResult::kAccepted);
}

TEST(TickGate, IgnoresForecastsOfImagesBeforeItsFirstTickInEitherOrder) {
  for (const bool forecast_first : {true, false}) {
    TickGate gate(kGate);
    if (forecast_first) gate.push_forecast(forecast(milliseconds(70)));
    gate.push_tick(milliseconds(100));
    if (!forecast_first) {
      EXPECT_EQ(gate.push_forecast(forecast(milliseconds(70))), PushResult::kOld);
    }
    gate.push_forecast(forecast(milliseconds(100)));
    std::string processed;
    while (const auto tick = gate.next()) processed += describe(*tick);
    for (int i = 11; i < 17; ++i) {
      gate.push_tick(i * kTickPeriod);
      while (const auto tick = gate.next()) processed += describe(*tick);
    }
    EXPECT_EQ(processed,
              "100000000:\n110000000:\n120000000:\n130000000:\n140000000:\n150000000:\n"
              "160000000: f100000000\n");
  }
}

TEST(TickGate, IgnoresWhatIsLeftOfAnotherRunBeforeItsFirstTick) {
  TickGate gate(kGate);
  EXPECT_EQ(gate.push_forecast(forecast(std::chrono::seconds(90))), PushResult::kAccepted);
  EXPECT_EQ(gate.push_plan_result(plan_result(std::chrono::seconds(90))), PushResult::kOld);
  gate.push_tick(Stamp{0});
  EXPECT_EQ(gate.push_forecast(forecast(Stamp{0})), PushResult::kAccepted);
  EXPECT_EQ(gate.push_plan_result(plan_result(Stamp{0})), PushResult::kAccepted);
  EXPECT_EQ(describe(*gate.next()), "0:\n");
}

TEST(GateParams, AreRefusedByName) {
  for (const auto& [culprit, parameters] : std::vector<std::pair<std::string, GateParams>>{
           {"pipeline_delay", {Duration{0}, milliseconds(33), milliseconds(300)}},
           {"camera_period", {milliseconds(60), milliseconds(4), milliseconds(300)}},
           {"max_wait", {milliseconds(60), milliseconds(33), milliseconds(-1)}}}) {
    try {
      TickGate gate(parameters);
      ADD_FAILURE() << "accepted: " << culprit;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(culprit, 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace prf_decision
