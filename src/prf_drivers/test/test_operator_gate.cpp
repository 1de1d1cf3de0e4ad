// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/operator_gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace prf_drivers {
namespace {

TEST(OperatorGate, LetsTheArmMoveWhenNothingIsAsked) {
  EXPECT_EQ(OperatorGate({false, 0.2, false}).veto(0.0), "");
}

// Fault 46: the dead-man's switch is released, or its messages stop coming -> the arm is held
TEST(OperatorGate, NeedsASwitchThatKeepsComing) {
  OperatorGate gate({true, 0.2, false});
  EXPECT_NE(gate.veto(10.0), "");
  gate.enable(true, 10.0);
  EXPECT_EQ(gate.veto(10.1), "");
  EXPECT_NE(gate.veto(10.3), "");
  gate.enable(true, 11.0);
  gate.enable(false, 11.1);
  EXPECT_NE(gate.veto(11.1), "");
  gate.enable(true, 12.0);
  EXPECT_NE(gate.veto(std::nan("")), "");
}

TEST(OperatorGate, StopsUntilItIsResetWhateverElseAllowsMotion) {
  OperatorGate gate({true, 0.2, false});
  gate.enable(true, 1.0);
  gate.stop();
  gate.hold(false);
  EXPECT_TRUE(gate.stopped());
  EXPECT_NE(gate.veto(1.0).find("~reset"), std::string::npos);
  gate.reset();
  EXPECT_EQ(gate.veto(1.0), "");
}

TEST(OperatorGate, HoldsUntilTheHoldIsTakenOff) {
  OperatorGate gate({false, 0.2, false});
  gate.hold(true);
  EXPECT_EQ(gate.veto(1.0), "the operator holds, until the service ~hold is called with false");
  gate.hold(false);
  EXPECT_EQ(gate.veto(1.0), "");
}

TEST(OperatorGate, LetsNothingMoveBeforeTheCheckIsGreen) {
  OperatorGate gate({false, 0.2, true});
  EXPECT_NE(gate.veto(1.0), "");
  gate.checked("no camera");
  EXPECT_EQ(gate.veto(1.0), "the bring-up check found: no camera");
  gate.checked("");
  EXPECT_EQ(gate.veto(1.0), "");
}

TEST(OperatorGate, RefusesATimeoutBeyondItsBounds) {
  EXPECT_THROW(OperatorGate({true, 0.0, false}), std::invalid_argument);
  EXPECT_THROW(OperatorGate({true, std::nan(""), false}), std::invalid_argument);
}

}  // namespace
}  // namespace prf_drivers
