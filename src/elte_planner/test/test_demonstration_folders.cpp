// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/demonstration_folders.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace elte_planner {
namespace {

namespace fs = std::filesystem;

// skills/first.csv, skills/sub/second.csv, more/third.csv, secret/key; links from skills to both.
struct DemonstrationFoldersTest : testing::Test {
  DemonstrationFoldersTest() {
    for (const char* folder : {"skills/sub", "more", "secret", "skills2"}) {
      fs::create_directories(root / folder);
    }
    for (const char* file :
         {"skills/first.csv", "skills/sub/second.csv", "more/third.csv", "secret/key"}) {
      std::ofstream(root / file) << file;
    }
    fs::create_symlink(root / "secret" / "key", root / "skills" / "link.csv");
    fs::create_symlink(root / "secret", root / "skills" / "folder");
    fs::create_symlink("first.csv", root / "skills" / "same.csv");
  }
  ~DemonstrationFoldersTest() override { fs::remove_all(root); }

  std::string path(const std::string& name) const { return (root / name).string(); }

  const fs::path root = fs::canonical(fs::temp_directory_path()) /
                        ("demonstration_folders_" + std::to_string(getpid()));
};

TEST_F(DemonstrationFoldersTest, HoldTheFolderOfTheFirstFileAndTheConfiguredOnes) {
  const DemonstrationFolders alone(path("skills/first.csv"));
  EXPECT_EQ(alone.resolve("first.csv"), path("skills/first.csv"));
  EXPECT_EQ(alone.resolve("sub/../sub/second.csv"), path("skills/sub/second.csv"));
  EXPECT_EQ(alone.resolve(path("skills/same.csv")), path("skills/first.csv"));
  EXPECT_EQ(alone.resolve("absent.csv"), path("skills/absent.csv"));
  EXPECT_THROW((void)alone.resolve(path("more/third.csv")), std::invalid_argument);
  const DemonstrationFolders both(path("skills/first.csv"), ":" + path("more") + ":");
  EXPECT_EQ(both.resolve(path("more/third.csv")), path("more/third.csv"));
  EXPECT_EQ(both.resolve("../more/third.csv"), path("more/third.csv"));
}

// Fault 55: a message names a file elsewhere, by .., a link or NUL -> refused, the file not opened
TEST_F(DemonstrationFoldersTest, RefuseWhateverLeadsOut) {
  const DemonstrationFolders folders(path("skills/first.csv"), path("more"));
  for (const std::string& name :
       {std::string("/etc/passwd"), path("secret/key"), std::string("../secret/key"),
        std::string("link.csv"), std::string("folder/key"), std::string("sub/../../secret/key"),
        path("skills2/x.csv"), std::string("first.csv\0x", 11), std::string("a/", 2) + "..//../x",
        std::string(100000, 'a')}) {
    try {
      (void)folders.resolve(name);
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& refusal) {
      EXPECT_LT(std::string(refusal.what()).size(), 600u);
    }
  }
}

TEST_F(DemonstrationFoldersTest, MustExist) {
  EXPECT_THROW(DemonstrationFolders(path("skills/first.csv"), path("absent")),
               std::invalid_argument);
  EXPECT_THROW(DemonstrationFolders(path("skills/first.csv"), path("more/third.csv")),
               std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
