// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/quoted.hpp"

#include <gtest/gtest.h>

namespace prf_core {
namespace {

TEST(Quoted, EscapesWhatIsNotPrintable) {
  EXPECT_EQ(quoted(""), "\"\"");
  EXPECT_EQ(quoted("base_link"), "\"base_link\"");
  EXPECT_EQ(quoted("a \"b\" \\"), "\"a \\\"b\\\" \\\\\"");
  EXPECT_EQ(quoted("link\n[FATAL]\t\x1b[2J\x7f"), "\"link\\n[FATAL]\\t\\x1b[2J\\x7f\"");
  EXPECT_EQ(quoted(std::string("\0\xc3\xa9", 3)), "\"\\x00\\xc3\\xa9\"");
}

TEST(Quoted, HasAtMostTwoHundredCharacters) {
  EXPECT_EQ(quoted(std::string(198, 'x')), "\"" + std::string(198, 'x') + "\"");
  EXPECT_EQ(quoted(std::string(199, 'x')), "\"" + std::string(195, 'x') + "\"...");
  for (std::size_t length = 0; length < 400; ++length) {
    for (const char character : {'x', '\n', '\x01'}) {
      EXPECT_LE(quoted(std::string(length, character)).size(), kMaxQuoted);
    }
  }
  EXPECT_EQ(quoted(std::string(1'000'000, '\x01')).substr(180), "1\\x01\\x01\\x01\"...");
}

}  // namespace
}  // namespace prf_core
