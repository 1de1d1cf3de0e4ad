// SPDX-License-Identifier: BSD-3-Clause
#include "options.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace platform_sim {
namespace {

Options options_of(std::vector<std::string> words) {
  words.insert(words.begin(), "command");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  return Options(static_cast<int>(pointers.size()), pointers.data());
}

TEST(Options, GivesWhatWasSaidElseTheDefault) {
  Options options = options_of({"--out", "a b", "--seed", "3", "--rate", "-2.5e1"});
  EXPECT_EQ(options.text("out"), "a b");
  EXPECT_EQ(options.integer("seed", 1), 3);
  EXPECT_EQ(options.number("rate", 1.0), -25.0);
  EXPECT_EQ(options.number("duration", 40.0), 40.0);
  EXPECT_EQ(options.text("gait", "stand"), "stand");
  EXPECT_NO_THROW(options.refuse_unknown());
}

TEST(Options, RefusesWhatItCannotRead) {
  EXPECT_THROW(options_of({"out"}), std::invalid_argument);
  EXPECT_THROW(options_of({"--out"}), std::invalid_argument);
  EXPECT_THROW(options_of({"--out", "a", "--out", "b"}), std::invalid_argument);
  EXPECT_THROW(options_of({}).text("out"), std::invalid_argument);
  for (const char* word : {"", "x", "3x", "1e999", "nan", "inf"}) {
    EXPECT_THROW((void)options_of({"--n", word}).number("n", 1.0), std::invalid_argument) << word;
    EXPECT_THROW((void)options_of({"--n", word}).integer("n", 1), std::invalid_argument) << word;
  }
  EXPECT_THROW((void)options_of({"--n", "3.5"}).integer("n", 1), std::invalid_argument);
  EXPECT_THROW(options_of({"--sed", "3"}).refuse_unknown(), std::invalid_argument);
}

}  // namespace
}  // namespace platform_sim
