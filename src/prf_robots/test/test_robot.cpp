// SPDX-License-Identifier: BSD-3-Clause
#include "prf_robots/robot.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace prf_robots {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A copy of a robot's folder whose files are changed.
class RobotFolder : public testing::Test {
 protected:
  void SetUp() override { take("ur5e_deck"); }
  void TearDown() override { fs::remove_all(folder_); }

  void take(const std::string& name) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy(fs::path(ROBOTS_DIR) / name, folder_);
  }

  void replace(const std::string& file, const std::string& old, const std::string& with) {
    std::string text = content(folder_ / file);
    const auto at = text.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    std::ofstream(folder_ / file) << text.replace(at, old.size(), with);
  }

  std::string refusal() const {
    try {
      (void)load_robot(folder_.string());
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "not refused";
  }

  void expect_refusal(const std::vector<std::string>& words) const {
    const std::string text = refusal();
    for (const std::string& word : words) {
      EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
    }
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }

  // Refused for a robot.yaml with this instead of that, with these words.
  void expect_refused(const std::string& old, const std::string& with,
                      const std::vector<std::string>& words) {
    SCOPED_TRACE(with);
    replace("robot.yaml", old, with);
    expect_refusal(words);
    expect_refusal({"robot.yaml: "});
    take("ur5e_deck");
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "prf_robots_test_robot";
};

TEST(Robots, OfThisPackageLoad) {
  int found = 0;
  for (const auto& entry : fs::directory_iterator(ROBOTS_DIR)) {
    SCOPED_TRACE(entry.path());
    const Robot robot = load_robot(entry.path().string());
    EXPECT_EQ(robot.kinematics->joint_count(), static_cast<int>(robot.joints.size()));
    const Eigen::Isometry3d ready = robot.kinematics->forward(robot.ready);
    const auto again = robot.kinematics->inverse(ready, robot.ready, {1});
    EXPECT_TRUE(again.solved);
    EXPECT_LT((again.q - robot.ready).norm(), 1e-6);
    ++found;
  }
  EXPECT_GE(found, 4);
}

// The flange of the UR5e with all joints at 0, from its Denavit-Hartenberg parameters.
TEST(Robots, Ur5eReachesWhereItsParametersSay) {
  const Robot robot = load_robot(std::string(ROBOTS_DIR) + "/ur5e_deck");
  const Eigen::Isometry3d tool = robot.kinematics->forward(JointVector::Zero(6));
  const Eigen::Vector3d flange = tool * Eigen::Vector3d(0.0, 0.0, -0.12);
  EXPECT_NEAR(flange.x(), -0.425 - 0.3922, 1e-9);
  EXPECT_NEAR(flange.y(), -0.1333 - 0.0996, 1e-9);
  EXPECT_NEAR(flange.z(), 0.1625 - 0.0997, 1e-9);
}

// Fault 45: robot.yaml with an unknown, missing or wrong key -> refused with file, key, value,
// bound
TEST_F(RobotFolder, RefusesKeysThatAreNotRight) {
  expect_refused("driver_period:", "period:", {"unknown key \"period\"", "driver_period"});
  expect_refused("driver_period: 0.01", "", {"driver_period missing"});
  expect_refused("0.01", "0.5", {"driver_period = \"0.5\"", "[0.002, 0.025]"});
  expect_refused("0.01", "[]", {"driver_period", "a number within"});
  expect_refused("tip_link: tool", "tip_link: [tool]", {"tip_link", "a name"});
  expect_refused("[-0.595,", "[", {"ready", "6 numbers"});
  expect_refused("[-0.595,", "[.nan,", {"ready", ".nan"});
  expect_refused("-2.208", "-3.5", {"ready = -3.5", "3.14159", "elbow_joint"});
  expect_refused("driver_period", "jerk: [1, 1, 1, 1, 1, 0]\ndriver_period", {"jerk = \"0\""});
  expect_refused("driver_period", "kinematics: magic\ndriver_period",
                 {"\"magic\"", "chain or jaco2"});
  expect_refused("base_link: arm_base", "base_link: [", {"no YAML"});
}

// Fault 45: links or joints that are not the URDF's -> refused, with those that it has
TEST_F(RobotFolder, RefusesNamesThatAreNotOfTheUrdf) {
  replace("robot.yaml", "tip_link: tool", "tip_link: hand");
  expect_refusal({"robot.urdf: ", "no link", "\"hand\""});
  take("ur5e_deck");
  expect_refused("wrist_3_joint]", "wrist_4_joint]",
                 {"joints = [", "wrist_4_joint", "wrist_3_joint]"});
  expect_refused("camera_optical_frame", "forearm_link",
                 {"camera_frame = \"forearm_link\"", "wrist_3_joint"});
}

// Fault 45: the closed form for another arm -> refused
TEST_F(RobotFolder, RefusesTheClosedFormOfAnotherArm) {
  replace("robot.yaml", "driver_period", "kinematics: jaco2\ndriver_period");
  expect_refusal({"kinematics = jaco2", "must be chain"});
  take("jaco_v60");
  replace("robot.urdf", "0.15675", "0.16675");
  expect_refusal({"kinematics = jaco2", "lengths or axes"});
  take("jaco_v60");
  replace("robot.urdf", "upper=\"5.46", "upper=\"5.36");
  expect_refusal({"kinematics = jaco2", "the limits"});
}

TEST_F(RobotFolder, RefusesFilesThatAreNotThere) {
  fs::remove(folder_ / "robot.urdf");
  expect_refusal({"robot.urdf"});
  fs::remove_all(folder_);
  expect_refusal({"robot.yaml"});
  EXPECT_EQ(robot_folder("a/b"), "a/b");
  EXPECT_THROW((void)robot_folder("no_such_robot"), std::invalid_argument);
}

}  // namespace
}  // namespace prf_robots
