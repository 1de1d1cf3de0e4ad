// SPDX-License-Identifier: BSD-3-Clause
// What the tick gate does with messages that are out of order, or of another run.
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "gate_world.hpp"

namespace prf_decision {
namespace {

// Fault 40: one tick, forecast, plan or report late, early or doubled -> dropped; the run goes
// on
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
  EXPECT_EQ(gate.push_control_report(report(Stamp{0})), PushResult::kAccepted);
  EXPECT_EQ(gate.push_control_report(report(Stamp{0})), PushResult::kOld);
  EXPECT_EQ(gate.push_control_report(report(milliseconds(1001))), PushResult::kFarAhead);
  EXPECT_EQ(gate.push_tick(milliseconds(5000)), PushResult::kFarAhead);
  EXPECT_EQ(gate.push_tick(milliseconds(10)), PushResult::kAccepted);
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

// Fault 40: forecasts and plans that go back -> dropped; only the ticks begin a new run
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
    std::string processed = process(gate);
    processed += tick_through(gate, 11, 17);
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
           {"pipeline_delay", {Duration{0}, milliseconds(33), milliseconds(50), milliseconds(300)}},
           {"camera_period",
            {milliseconds(60), milliseconds(4), milliseconds(50), milliseconds(300)}},
           {"control_delay",
            {milliseconds(60), milliseconds(33), milliseconds(0), milliseconds(300)}},
           {"max_wait",
            {milliseconds(60), milliseconds(33), milliseconds(50), milliseconds(-1)}}}) {
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
