// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/speed_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace prf_core {
namespace {

TEST(SpeedScale, IsOneBeforeTheFirstAnnouncement) { EXPECT_EQ(SpeedScale().at(Stamp(5)), 1.0); }

TEST(SpeedScale, ChangesAtTheTickThatWasAnnounced) {
  SpeedScale scale;
  scale.announce(Stamp(10), 0.5);
  scale.announce(Stamp(20), 0.0);
  EXPECT_EQ(scale.at(Stamp(9)), 1.0);
  EXPECT_EQ(scale.at(Stamp(10)), 0.5);
  EXPECT_EQ(scale.at(Stamp(19)), 0.5);
  EXPECT_EQ(scale.at(Stamp(35)), 0.0);
}

TEST(SpeedScale, ReplacesWhatWasAnnouncedForLater) {
  SpeedScale scale;
  scale.announce(Stamp(20), 1.0);
  scale.announce(Stamp(15), 0.2);
  EXPECT_EQ(scale.at(Stamp(30)), 0.2);
}

TEST(SpeedScale, BeginsAnewWithARun) {
  SpeedScale scale;
  scale.announce(Stamp(10), 0.5);
  EXPECT_EQ(scale.at(Stamp(10)), 0.5);
  scale.reset();
  EXPECT_EQ(scale.at(Stamp(1)), 1.0);
}

// Fault 1: a scale that is not a number or beyond 0 to 1 -> it is refused, the one before holds
TEST(SpeedScale, RefusesWhatIsNoShare) {
  SpeedScale scale;
  scale.announce(Stamp(1), 0.5);
  for (const double bad : {std::nan(""), -0.1, 1.01, HUGE_VAL}) {
    EXPECT_THROW(scale.announce(Stamp(2), bad), std::invalid_argument);
  }
  EXPECT_EQ(scale.at(Stamp(3)), 0.5);
}

}  // namespace
}  // namespace prf_core
