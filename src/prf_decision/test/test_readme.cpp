// SPDX-License-Identifier: BSD-3-Clause
// The tables of README.md are those of the code: `rosrun prf_decision print_fsm` prints them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "prf_decision/decision_fsm.hpp"
#include "prf_decision/demonstration_switch.hpp"
#include "prf_decision/guards.hpp"

namespace prf_decision {
namespace {

TEST(Readme, HoldsTheTablesOfTheCode) {
  std::stringstream readme;
  readme << std::ifstream("README.md").rdbuf();
  ASSERT_FALSE(readme.str().empty());
  for (const std::string& table : {fsm_markdown(), switch_markdown(), guards_markdown()}) {
    EXPECT_NE(readme.str().find("\n\n" + table + "\n"), std::string::npos) << table;
  }
}

}  // namespace
}  // namespace prf_decision
