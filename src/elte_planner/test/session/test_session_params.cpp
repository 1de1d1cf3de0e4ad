// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "reach_skill.hpp"

namespace elte_planner {
namespace {

// Fault 28, 52: garbage or absurd parameters of the planner -> refused by name, bounded on both
// sides
TEST(SessionParams, RefuseWhatIsOutOfRangeByName) {
  EXPECT_NO_THROW(SkillSession(params(), reach()));
  const auto refused = [](const std::string& name, auto&& change) {
    SessionParams bad = params();
    change(bad);
    try {
      SkillSession session(bad, reach());
      FAIL() << name << " accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refused("planner", [](SessionParams& p) { p.planner = "bezier"; });
  refused("nodes", [](SessionParams& p) { p.nodes = 2; });
  refused("nodes", [](SessionParams& p) { p.nodes = -1; });
  refused("w_elastic", [](SessionParams& p) { p.weights.elastic = -1.0; });
  refused("w_bending", [](SessionParams& p) { p.weights.bending = std::nan(""); });
  refused("max_step", [](SessionParams& p) { p.max_step = -0.1; });
  refused("max_step", [](SessionParams& p) {
    p.planner = "dmp";
    p.max_step = 0.1;
  });
  refused("horizon_max", [](SessionParams& p) { p.horizon_max = std::nan(""); });
  refused("max_step", [](SessionParams& p) { p.max_step = 5e-324; });
  refused("nodes", [](SessionParams& p) { p.nodes = 2000000000; });
  refused("w_elastic", [](SessionParams& p) { p.weights.elastic = 1e308; });
  refused("horizon_max", [](SessionParams& p) { p.horizon_max = 1e308; });
  refused("confidence", [](SessionParams& p) { p.confidence = 1.0; });
  refused("confidence", [](SessionParams& p) { p.confidence = 5e-324; });
  refused("radius_max", [](SessionParams& p) { p.radius_max = 1e308; });
  refused("approach_length", [](SessionParams& p) { p.approach_length = 1e308; });
  refused("max_iterations", [](SessionParams& p) { p.max_iterations = 0; });
  refused("radius_min", [](SessionParams& p) { p.radius_min = -0.1; });
  refused("approach_length", [](SessionParams& p) { p.approach_length = -0.1; });
  refused("radius_max", [](SessionParams& p) { p.radius_max = 0.0005; });
}

}  // namespace
}  // namespace elte_planner
