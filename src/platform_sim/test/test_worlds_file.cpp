// SPDX-License-Identifier: BSD-3-Clause
// config/worlds.yaml says what the sources say.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "motion/motion_families.hpp"
#include "platform_sim/world.hpp"

namespace platform_sim {
namespace {

using Names = std::vector<std::string>;

TEST(WorldsFile, NamesWhatTheSourcesName) {
  const YAML::Node file = YAML::LoadFile(std::string(CONFIG_DIR) + "/worlds.yaml");
  EXPECT_EQ(file["scenarios"].as<Names>(), WorldParams::scenario_names());
  EXPECT_EQ(file["gaits"].as<Names>(), World::gait_names());
  EXPECT_EQ(file["motion_families"].as<Names>(), family_names());
  EXPECT_EQ(file["highest_motion_level"].as<double>(), kHighestLevel);
  Names disturbances;
  std::vector<double> highest;
  for (const Disturbances::Kind& kind : Disturbances::kinds()) {
    disturbances.emplace_back(kind.name);
    highest.push_back(kind.highest);
  }
  EXPECT_EQ(file["disturbances"].as<Names>(), disturbances);
  EXPECT_EQ(file["highest_levels"].as<std::vector<double>>(), highest);
}

}  // namespace
}  // namespace platform_sim
