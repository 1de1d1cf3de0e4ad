// SPDX-License-Identifier: BSD-3-Clause
#include "arm_kinematics/chain.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "arms.hpp"

namespace arm_kinematics {
namespace {

std::string refusal(const std::string& urdf, const std::string& base = "base",
                    const std::string& tip = "tip") {
  try {
    (void)chain_from_urdf(urdf, base, tip);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "not refused";
}

std::string replaced(std::string text, const std::string& old, const std::string& with) {
  const auto at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), with);
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
  }
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

TEST(Chain, NamesJointsFromBaseToTipWithTheirLimits) {
  const Chain chain = chain_from_urdf(arm_urdf(6), "base", "tip");
  ASSERT_EQ(chain.joints.size(), 6U);
  EXPECT_EQ(chain.joints.front().name, "j1");
  EXPECT_EQ(chain.joints.back().name, "j6");
  EXPECT_EQ(chain.limits.lower[1], -2.0);
  EXPECT_EQ(chain.limits.upper[1], 2.5);
  EXPECT_EQ(chain.limits.velocity[1], 1.5);
  EXPECT_TRUE(std::isinf(chain.limits.upper[0])) << "j1 is continuous";
}

// Fault 45: a URDF without the named links -> refused, with the link
TEST(Chain, RefusesLinksThatAreNotThere) {
  expect_words(refusal(arm_urdf(6), "elsewhere"), {"no link", "elsewhere"});
  expect_words(refusal(arm_urdf(6), "tip", "base"), {"\"base\"", "is not carried by", "\"tip\""});
  expect_words(refusal("<robot"), {"cannot be read", "must be"});
}

TEST(Chain, RefusesTooFewAndTooManyJoints) {
  expect_words(refusal(arm_urdf(4)), {"4 joints move", "must be 5 to 8"});
  expect_words(refusal(arm_urdf(9)), {"9 joints move", "must be 5 to 8"});
  expect_words(refusal(arm_urdf(6), "base", "base"), {"0 joints move"});
}

// Fault 45: two joints carry one link, a loop -> refused, with the link
TEST(Chain, RefusesALoop) {
  const std::string second =
      "<joint name='again' type='fixed'><parent link='l1'/><child link='l4'/></joint></robot>";
  expect_words(refusal(replaced(arm_urdf(6), "</robot>", second)),
               {"\"l4\"", "two joints", "loop"});
}

// Fault 45: limits missing, upside down or not finite -> refused, with joint, value and bound
TEST(Chain, RefusesLimitsThatMeanNothing) {
  const std::string limit = "<limit lower='-2.0' upper='2.5' velocity='1.5' effort='10'/>";
  const auto with = [&](const std::string& other) {
    return refusal(replaced(arm_urdf(6), limit, other));
  };
  expect_words(with("<limit lower='2' upper='-2' velocity='1' effort='1'/>"),
               {"upper limit", "\"j2\"", "= -2", "above the lower limit 2"});
  expect_words(with("<limit lower='-2' upper='2' velocity='0' effort='1'/>"),
               {"velocity limit", "\"j2\"", "= 0", "> 0"});
  expect_words(with("<limit lower='-2' upper='nan' velocity='1' effort='1'/>"), {"must be"});
  expect_words(with(""), {"must"});
}

TEST(Chain, RefusesJointsThatDoNotMoveOnTheirOwn) {
  const std::string axis = "<axis xyz='0 1 0'/>";
  expect_words(refusal(replaced(arm_urdf(6), axis, axis + "<mimic joint='j1'/>")),
               {"\"j2\"", "mimics", "\"j1\"", "on its own"});
  expect_words(refusal(replaced(arm_urdf(6), "type='continuous'", "type='planar'")),
               {"\"j1\"", "planar", "must be revolute"});
}

// A mesh that is not there is no matter of the chain.
TEST(Chain, AsksForNoMesh) {
  const std::string mesh =
      "<link name='l1'><collision><geometry><mesh filename='package://gone/x.stl'/></geometry>"
      "</collision></link>";
  EXPECT_EQ(chain_from_urdf(replaced(arm_urdf(6), "<link name='l1'/>", mesh), "base", "tip")
                .joints.size(),
            6U);
}

}  // namespace
}  // namespace arm_kinematics
