// SPDX-License-Identifier: BSD-3-Clause
// A catalogue of spoilt values, each of which validate() must refuse by name.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace prf_core {

template <typename Value>
void expect_refused(
    const Value& valid,
    const std::vector<std::pair<std::string, std::function<void(Value&)>>>& catalogue) {
  ASSERT_NO_THROW(valid.validate());
  for (const auto& [culprit, spoil] : catalogue) {
    Value value = valid;
    spoil(value);
    try {
      value.validate();
      ADD_FAILURE() << "accepted: " << culprit;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(culprit, 0), 0u) << error.what();
    }
  }
}

}  // namespace prf_core
