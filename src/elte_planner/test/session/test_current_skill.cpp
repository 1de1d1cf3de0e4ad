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

  CurrentSkill first_skill() const { return {params(), files("first.csv")}; }

  SkillFiles files(const std::string& name, const std::string& folders = "") const {
    SkillFiles result{path(name), "arm", {}, folders};
    result.limits.reach = 1.3;
    return result;
  }

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
       {std::pair("missing.csv", ": there is no such file"),
        std::pair("bad.csv", ":1: header is 'time,x'"),
        std::pair("elsewhere.csv", "must be 'world'"), std::pair("fifo", "must be a file"),
        std::pair(".", "must be a file")}) {
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

// Fault 51: one progress names another demonstration or a huge switch number -> costs one plan, the
// one before returns with its own
TEST_F(CurrentSkillTest, ComesBackWithItsPlanAfterARequestByMistake) {
  CurrentSkill skill = first_skill();
  for (const DemonstrationRequest& mistake :
       {DemonstrationRequest{"", 4294967295u}, DemonstrationRequest{"second.csv", 0}}) {
    const SkillSession* const before = &skill.session();
    EXPECT_EQ(skill.select(mistake), std::nullopt);
    EXPECT_NE(&skill.session(), before);
    EXPECT_EQ(skill.select({"", 0}), std::nullopt);
    EXPECT_EQ(&skill.session(), before);
  }
}

// Fault 55: a demonstration outside the configured folders -> refused with their names, the plan
// stays
TEST_F(CurrentSkillTest, OpensRequestedFilesOnlyInsideTheFolders) {
  std::filesystem::create_directories(folder / "inside");
  write("inside/first.csv", 0.1);
  CurrentSkill closed(params(), files("inside/first.csv"));
  const SkillSession* const before = &closed.session();
  const auto refusal = closed.select({"../second.csv", 1});
  ASSERT_TRUE(refusal);
  EXPECT_NE(refusal->find("outside demonstration_folders: "), std::string::npos) << *refusal;
  EXPECT_TRUE(closed.select({std::string(5000, 'a'), 2}));
  EXPECT_EQ(&closed.session(), before);
  CurrentSkill open(params(), files("inside/first.csv", folder.string()));
  EXPECT_EQ(open.select({"../second.csv", 1}), std::nullopt);
  EXPECT_NEAR(height(open), 0.2, 1e-12);
}

// Fault 48: demonstration out of reach, requested or first -> refused with file and row, nothing
// moves
TEST_F(CurrentSkillTest, RefusesWhatTheArmCannotReach) {
  write("high.csv", 1.35);
  EXPECT_THROW(CurrentSkill(params(), files("high.csv")), std::invalid_argument);
  CurrentSkill skill = first_skill();
  const auto refusal = skill.select({"high.csv", 1});
  ASSERT_TRUE(refusal);
  EXPECT_NE(refusal->find("high.csv: demonstration: row 11 is 1.44 m"), std::string::npos)
      << *refusal;
}

TEST_F(CurrentSkillTest, RefusesABadFirstOne) {
  EXPECT_THROW(CurrentSkill(params(), files("missing.csv")), std::invalid_argument);
  SkillFiles elsewhere = files("first.csv");
  elsewhere.frame = "world";
  EXPECT_THROW(CurrentSkill(params(), elsewhere), std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
