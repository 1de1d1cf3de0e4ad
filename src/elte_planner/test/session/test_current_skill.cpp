// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/current_skill.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace elte_planner {
namespace {

// A folder of demonstrations that end at different heights.
struct CurrentSkillTest : testing::Test {
  CurrentSkillTest() {
    std::filesystem::create_directories(folder);
    write("first.csv", 0.1);
    write("second.csv", 0.2);
  }
  ~CurrentSkillTest() override { std::filesystem::remove_all(folder); }

  void write(const std::string& name, double height, const std::string& frame = "arm") const {
    std::ofstream file(folder / name);
    file << "# frame: " << frame << "\n# child_frame: hand\n# target_pose: 1 0 0.5 0 0 0 1\n"
         << "time,x,y,z,qx,qy,qz,qw\n";
    for (int i = 0; i <= 10; ++i) {
      file << 0.1 * i << ',' << 0.05 * i << ",0," << height * 0.1 * i << ",0,0,0,1\n";
    }
  }

  CurrentSkill first_skill() const { return {params(), path("first.csv"), "arm"}; }

  std::string path(const std::string& name) const { return (folder / name).string(); }

  static SessionParams params() {
    SessionParams result;
    result.planner = "elte";
    result.nodes = 10;
    result.confidence = 0.5;
    return result;
  }

  static double height(const CurrentSkill& skill) {
    return skill.session().demonstration().samples().back().pose.position.z();
  }

  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("current_skill_" + std::to_string(getpid()));
};

TEST_F(CurrentSkillTest, ChangesWithTheRequestAndComesBack) {
  CurrentSkill skill = first_skill();
  EXPECT_EQ(skill.select({"", 0}), std::nullopt);
  EXPECT_NEAR(height(skill), 0.1, 1e-12);
  EXPECT_EQ(skill.select({path("second.csv"), 1}), std::nullopt);
  EXPECT_NEAR(height(skill), 0.2, 1e-12);
  EXPECT_EQ(skill.demonstration(), path("second.csv"));
  EXPECT_EQ(skill.select({"first.csv", 2}), std::nullopt);  // beside the first one
  EXPECT_NEAR(height(skill), 0.1, 1e-12);
  EXPECT_EQ(skill.select({"second.csv", 3}), std::nullopt);
  EXPECT_EQ(skill.select({"", 0}), std::nullopt);  // a decision that was started anew
  EXPECT_EQ(skill.demonstration(), path("first.csv"));
}

// As a planner that was started anew amid the execution of another than its first one.
TEST_F(CurrentSkillTest, BeginsWithAnyRequest) {
  CurrentSkill skill = first_skill();
  EXPECT_EQ(skill.select({"second.csv", 7}), std::nullopt);
  EXPECT_NEAR(height(skill), 0.2, 1e-12);
}

TEST_F(CurrentSkillTest, StaysWhenTheRequestIsRefusedWithTheReadersReason) {
  write("elsewhere.csv", 0.3, "world");
  std::ofstream(folder / "bad.csv") << "time,x\n";
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  CurrentSkill skill = first_skill();
  ASSERT_EQ(skill.select({"second.csv", 1}), std::nullopt);
  const SkillSession* const before = &skill.session();
  std::uint32_t number = 1;
  for (const auto& [name, reason] :
       {std::pair("missing.csv", ": cannot be read"),
        std::pair("bad.csv", ":1: header is 'time,x'"),
        std::pair("elsewhere.csv", "must be 'world'"), std::pair("fifo", ": is no file"),
        std::pair(".", ": is no file")}) {
    const auto refusal = skill.select({name, ++number});
    ASSERT_TRUE(refusal) << name;
    EXPECT_NE(refusal->find(reason), std::string::npos) << *refusal;
    EXPECT_EQ(skill.select({name, number}), refusal);
  }
  EXPECT_EQ(skill.select({"second.csv", 1}), std::nullopt);
  EXPECT_EQ(&skill.session(), before);  // with its plan
}

TEST_F(CurrentSkillTest, IsReadWhenTheNumberChangesAndOnlyThen) {
  CurrentSkill skill = first_skill();
  ASSERT_EQ(skill.select({"second.csv", 1}), std::nullopt);
  ASSERT_TRUE(skill.select({"third.csv", 2}));
  write("second.csv", 0.4);
  write("third.csv", 0.3);
  EXPECT_TRUE(skill.select({"third.csv", 2}));
  EXPECT_EQ(skill.select({"second.csv", 1}), std::nullopt);
  EXPECT_NEAR(height(skill), 0.2, 1e-12);
  EXPECT_EQ(skill.select({"second.csv", 3}), std::nullopt);
  EXPECT_NEAR(height(skill), 0.4, 1e-12);
  EXPECT_EQ(skill.select({"third.csv", 4}), std::nullopt);
}

TEST_F(CurrentSkillTest, RefusesABadFirstOne) {
  EXPECT_THROW(CurrentSkill(params(), path("missing.csv"), "arm"), std::invalid_argument);
  EXPECT_THROW(CurrentSkill(params(), path("first.csv"), "world"), std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
