// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/private_parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace prf_ros {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using XmlRpc::XmlRpcValue;

XmlRpcValue sample() {
  XmlRpcValue values;
  values["rate"] = 2.5;
  values["nodes"] = 50;
  values["framework"] = true;
  values["planner"] = std::string("elte");
  values["gains"][0] = 1;
  values["gains"][1] = 0.5;
  values["ids"][0] = 3;
  return values;
}

template <typename Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(PrivateParameters, ReadsEachType) {
  PrivateParameters values(sample());
  EXPECT_EQ(values.number("rate"), 2.5);
  EXPECT_EQ(values.number("nodes"), 50.0);
  EXPECT_EQ(values.integer("nodes"), 50);
  EXPECT_TRUE(values.flag("framework"));
  EXPECT_EQ(values.text("planner"), "elte");
  EXPECT_THAT(values.numbers("gains", 2), ElementsAre(1.0, 0.5));
  EXPECT_THAT(values.integers("ids"), ElementsAre(3));
  EXPECT_NO_THROW(values.refuse_unknown());
}

TEST(PrivateParameters, ReadsABlockAsStrictly) {
  XmlRpcValue all = sample();
  all["camera"]["noise"] = 4.0;
  all["camera"]["gain"] = 1.0;
  PrivateParameters values(all);
  PrivateParameters camera = values.section("camera");
  EXPECT_EQ(camera.number("noise"), 4.0);
  EXPECT_THAT(refusal([&] { (void)camera.text("noise"); }), HasSubstr("camera/noise = 4"));
  EXPECT_THAT(refusal([&] { (void)camera.number("width"); }), HasSubstr("camera/width is missing"));
  EXPECT_THAT(refusal([&] { camera.refuse_unknown(); }), HasSubstr("camera/gain = 1"));
  EXPECT_THAT(refusal([&] { (void)values.section("rate"); }), HasSubstr("a block"));
}

TEST(PrivateParameters, NamesTheMissingKey) {
  PrivateParameters values(sample());
  EXPECT_THAT(refusal([&] { (void)values.number("radius"); }), HasSubstr("radius is missing"));
}

// Fault 28: a parameter is missing or of another type -> the node refuses to start and names it
TEST(PrivateParameters, NamesKeyValueAndTypeWhenTheTypeIsWrong) {
  PrivateParameters values(sample());
  EXPECT_EQ(refusal([&] { (void)values.integer("rate"); }), "rate = 2.5, must be an integer");
  EXPECT_EQ(refusal([&] { (void)values.number("planner"); }),
            "planner = \"elte\", must be a number");
  EXPECT_EQ(refusal([&] { (void)values.flag("nodes"); }), "nodes = 50, must be true or false");
  EXPECT_EQ(refusal([&] { (void)values.text("nodes"); }), "nodes = 50, must be a string");
  EXPECT_THAT(refusal([&] { (void)values.numbers("rate"); }), HasSubstr("rate = 2.5"));
  EXPECT_THAT(refusal([&] { (void)values.numbers("gains", 3); }), HasSubstr("list of 3 numbers"));
  EXPECT_THAT(refusal([&] { (void)values.integers("gains"); }),
              HasSubstr("gains[1] = 0.5, must be an integer"));
}

// Fault 28: 3e-4 in YAML, which is a text there -> the message says so, and how to write it
TEST(PrivateParameters, SaysWhyWhatLooksLikeANumberIsNone) {
  XmlRpcValue one;
  for (const char* word : {"3e-4", "1e3", "+5", "0.1"}) {
    one["floor"] = std::string(word);
    one["floors"][0] = 1.0;
    one["floors"][1] = std::string(word);
    PrivateParameters values(one);
    EXPECT_THAT(refusal([&] { (void)values.number("floor"); }),
                HasSubstr("floor = \"" + std::string(word) + "\" (a text: YAML 1.1"));
    EXPECT_THAT(refusal([&] { (void)values.integer("floor"); }), HasSubstr("3.0e-4"));
    EXPECT_THAT(refusal([&] { (void)values.numbers("floors"); }), HasSubstr("3.0e-4"));
  }
  one["floor"] = std::string("\x1b[2J");
  EXPECT_EQ(refusal([&] { (void)PrivateParameters(one).number("floor"); }),
            "floor = \"\\x1b[2J\", must be a number");
}

TEST(PrivateParameters, RefusesAKeyThatNothingReads) {
  XmlRpcValue one;
  one["raet"] = 1.0;
  const PrivateParameters values(one);
  EXPECT_THAT(refusal([&] { values.refuse_unknown(); }), HasSubstr("raet = 1"));
}

TEST(PrivateParameters, LeavesReservedKeysOfRosAlone) {
  XmlRpcValue one;
  one["__reserved"] = 1.0;
  EXPECT_NO_THROW(PrivateParameters(one).refuse_unknown());
}

TEST(Run, TurnsARefusalIntoExitCodeTwo) {
  EXPECT_EQ(run([] { throw std::invalid_argument("rate = -1, must be > 0"); }), 2);
  EXPECT_EQ(run([] {}), 0);
}

// Fault 42: an exception that nothing handles -> one fatal line names it, exit code 3, no abort
TEST(Run, TurnsAnyOtherExceptionIntoExitCodeThree) {
  EXPECT_EQ(run([] { throw std::runtime_error("time is out of dual 32-bit range"); }), 3);
  EXPECT_EQ(run([] { throw std::bad_alloc(); }), 3);
  EXPECT_EQ(run([] { throw 7; }), 3);
}

}  // namespace
}  // namespace prf_ros
