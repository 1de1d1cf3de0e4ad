// SPDX-License-Identifier: BSD-3-Clause
//
// The CSV reader on damaged files: whatever comes in, a valid demonstration or one line of refusal
// comes out. ELTE_PLANNER_FUZZ_INPUTS says how many (default 20000).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

#include "elte_planner/demonstration.hpp"

namespace elte_planner {
namespace {

const std::string kValid =
    "# frame: arm\n# child_frame: hand\n# target_pose: 1 0 0.5 0 0 0 1\n"
    "time,x,y,z,qx,qy,qz,qw\n"
    "0,0,0,0,0,0,0,1\n1,0.1,0,0,0,0,0,1\n2,0.1,0.3,0,0,0,0.70710678,0.70710678\n";

class Damage {
 public:
  explicit Damage(unsigned seed) : random_(seed) {}

  std::string of(std::string text) {
    for (std::size_t i = 0, count = 1 + pick(4); i < count; ++i) change(text);
    return text;
  }

 private:
  std::size_t pick(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }

  void change(std::string& text) {
    static const std::string kPieces[] = {"nan",
                                          "-inf",
                                          "1e999",
                                          "-",
                                          ",",
                                          "\n",
                                          "\r",
                                          "\t",
                                          "#",
                                          ":",
                                          "0x",
                                          "1e-9",
                                          "\"",
                                          "# frame: x\n",
                                          "99999999999999999999",
                                          "1,2,3,4,5,6,7,8\n"};
    const std::size_t at = pick(text.size() + 1);
    const std::size_t length = std::min(pick(20), text.size() - at);
    switch (pick(5)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(pick(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(pick(text.size() + 1), pick(60)));
        break;
      case 3:
        text.insert(at, kPieces[pick(std::size(kPieces))]);
        break;
      default:
        if (at < text.size()) text[at] = "0123456789.,-eE \n"[pick(17)];
    }
  }

  std::mt19937 random_;
};

TEST(DamagedDemonstrationFile, IsReadOrRefusedInOneLine) {
  const char* const asked = std::getenv("ELTE_PLANNER_FUZZ_INPUTS");
  const long inputs = asked == nullptr ? 20000 : std::atol(asked);
  ASSERT_GT(inputs, 0);
  Damage damage(1);
  long read = 0;
  for (long i = 0; i < inputs; ++i) {
    const std::string text = damage.of(kValid);
    try {
      std::istringstream in(text);
      const Demonstration demonstration = read_demonstration(in, "demo.csv");
      ASSERT_TRUE(demonstration.positions().allFinite()) << text;
      ASSERT_TRUE(demonstration.goal_in_target().is_finite()) << text;
      ASSERT_TRUE(demonstration.resampled_by_arc_length(10).positions().allFinite()) << text;
      ++read;
    } catch (const std::invalid_argument& refusal) {
      const std::string message = refusal.what();
      ASSERT_EQ(message.find_first_of("\r\n"), std::string::npos) << text;
      ASSERT_EQ(message.rfind("demo.csv", 0), 0u) << message;
    }
  }
  EXPECT_GT(read, inputs / 100);
  EXPECT_LT(read, inputs / 2);
  RecordProperty("read", std::to_string(read));
}

}  // namespace
}  // namespace elte_planner
