// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "elte_planner/skill_session.hpp"

namespace elte_planner {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Progress good() { return {seconds(10), milliseconds(9'950), 12, seconds(3), {"", 1}}; }

TEST(Progress, TakesWhatAnExecutionAsks) {
  EXPECT_NO_THROW(good().validate(50));
  Progress none = good();
  none.forecast_stamp = prf_core::Stamp{0};
  none.frozen = 0;
  none.time_to_go = prf_core::Duration{0};
  EXPECT_NO_THROW(none.validate(50));
  Progress all = good();
  all.frozen = 50;
  all.forecast_stamp = all.stamp + milliseconds(100);
  EXPECT_NO_THROW(all.validate(50));
}

// Fault 51: a progress with a forecast stamp far ahead, or an absurd prefix or time -> refused by
// name
TEST(Progress, RefusesWhatWouldWedgeThePlanner) {
  const auto refused = [](const std::string& name, auto&& spoil) {
    Progress bad = good();
    spoil(bad);
    try {
      bad.validate(50);
      ADD_FAILURE() << name << " accepted";
    } catch (const std::invalid_argument& refusal) {
      EXPECT_EQ(std::string(refusal.what()).rfind(name, 0), 0u) << refusal.what();
    }
  };
  refused("forecast_stamp", [](Progress& p) { p.forecast_stamp = p.stamp + milliseconds(101); });
  refused("forecast_stamp", [](Progress& p) { p.forecast_stamp = seconds(4'294'967'295); });
  refused("frozen", [](Progress& p) { p.frozen = 51; });
  refused("frozen", [](Progress& p) { p.frozen = 4'294'967'295; });
  refused("time_to_go", [](Progress& p) { p.time_to_go = seconds(-1); });
  refused("time_to_go", [](Progress& p) { p.time_to_go = seconds(2'147'483'647); });
}

}  // namespace
}  // namespace elte_planner
