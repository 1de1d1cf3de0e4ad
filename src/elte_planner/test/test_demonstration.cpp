// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/demonstration.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace elte_planner {
namespace {

constexpr char kMetadata[] = "# frame: arm\n# child_frame: hand\n# target_pose: 1 0 0.5 0 0 0 1\n";
constexpr char kHeader[] = "time,x,y,z,qx,qy,qz,qw\n";
constexpr char kRows[] =
    "0,0,0,0,0,0,0,1\n1,0.1,0,0,0,0,0,1\n2,0.1,0.3,0,0,0,0.70710678,0.70710678\n";

Demonstration parsed(const std::string& text) {
  std::istringstream in(text);
  return read_demonstration(in, "demo.csv");
}

Demonstration quarter_turn() { return parsed(std::string(kMetadata) + kHeader + kRows); }

TEST(DemonstrationFile, IsReadAsWritten) {
  const Demonstration demonstration = quarter_turn();
  ASSERT_EQ(demonstration.samples().size(), 3u);
  EXPECT_EQ(demonstration.frame(), "arm");
  EXPECT_EQ(demonstration.child_frame(), "hand");
  EXPECT_EQ(demonstration.samples()[2].time, 2.0);
  EXPECT_EQ(demonstration.positions()(2, 1), 0.3);
  EXPECT_NEAR(demonstration.samples()[2].pose.orientation.norm(), 1.0, 1e-15);
  EXPECT_NEAR(demonstration.length(), 0.4, 1e-15);
  EXPECT_NEAR(demonstration.goal_in_target().position.x(), -0.9, 1e-15);
  EXPECT_NEAR(demonstration.goal_in_target().position.z(), -0.5, 1e-15);
}

TEST(DemonstrationFile, ToleratesBlankLinesCommentsAndWindowsLineEnds) {
  const Demonstration demonstration = parsed(
      std::string("# recorded by hand\r\n\r\n") + kMetadata +
      "time,x,y,z,qx,qy,qz,qw\r\n0,0,0,0,0,0,0,1\r\n 1 , 0.1,0,0,0,0,0,1\n\n2,0.2,0,0,0,0,0,1");
  EXPECT_EQ(demonstration.samples().size(), 3u);
}

struct SavedDemonstration : testing::Test {
  ~SavedDemonstration() override { std::filesystem::remove(path); }
  const std::string path = testing::TempDir() + "saved_" + std::to_string(getpid()) + ".csv";
};

TEST_F(SavedDemonstration, IsReadBackWithItsNotes) {
  const Demonstration made =
      parsed("# operator: M. M.\n# when: 12:30\n" + (std::string(kMetadata) + kHeader + kRows));
  EXPECT_EQ(made.notes(), (Demonstration::Notes{{"operator", "M. M."}, {"when", "12:30"}}));
  save_demonstration(made.resampled_by_arc_length(7), path);
  const Demonstration read = load_demonstration(path);
  const Demonstration expected = made.resampled_by_arc_length(7);
  EXPECT_EQ(read.notes(), made.notes());
  EXPECT_EQ(read.frame(), "arm");
  EXPECT_EQ(read.child_frame(), "hand");
  EXPECT_EQ(read.target().position, made.target().position);
  ASSERT_EQ(read.samples().size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) {
    const TimedPose& a = read.samples()[i];
    const TimedPose& b = expected.samples()[i];
    EXPECT_NEAR(a.time, b.time, 0.51e-6);
    EXPECT_LE((a.pose.position - b.pose.position).cwiseAbs().maxCoeff(), 0.51e-9);
    EXPECT_LE((a.pose.orientation.coeffs() - b.pose.orientation.coeffs()).norm(), 2e-9);
  }
}

TEST_F(SavedDemonstration, IsRefusedWhenItCannotBeReadBack) {
  const auto refused = [this](const std::string& expected, const std::vector<TimedPose>& samples,
                              const Demonstration::Notes& notes, const std::string& file) {
    try {
      save_demonstration(Demonstration(samples, "arm", "hand", Pose{}, notes), file);
      ADD_FAILURE() << expected;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(path));
  };
  std::vector<TimedPose> samples = quarter_turn().samples();
  refused("notes cannot", samples, {{"a:b", "c"}}, path);
  refused("notes cannot", samples, {{"a", " b"}}, path);
  refused("notes cannot", samples, {{"a", "b\n#c"}}, path);
  refused("header is 'c'", samples, {{"a", "b\nc"}}, path);
  refused("key 'frame' is given twice", samples, {{"frame", "arm"}}, path);
  refused("cannot be written", samples, {}, "/nonexistent/demo.csv");
  samples[1].time = 1e-8;  // within the microsecond of the first
  refused("column 'time'", samples, {}, path);
}

TEST(DouglasPeucker, TakesCornersFirstAndKeepsTheirTimes) {
  std::vector<TimedPose> samples;
  const double corners[][2] = {{0, 0}, {1, 0}, {1, 1}, {3, 1}};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 7; ++k) {
      const double s = k / 7.0;
      samples.push_back({static_cast<double>(samples.size()),
                         {{(1 - s) * corners[i][0] + s * corners[i + 1][0],
                           (1 - s) * corners[i][1] + s * corners[i + 1][1], 0.0},
                          Eigen::Quaterniond::Identity()}});
    }
  }
  samples.push_back({21.0, {{3, 1, 0}, Eigen::Quaterniond::Identity()}});
  const Demonstration drawn(samples, "arm", "hand", Pose{});
  const Demonstration four = drawn.resampled_by_douglas_peucker(4);
  ASSERT_EQ(four.samples().size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(four.samples()[i].time, 7.0 * double(i));
  EXPECT_NEAR(four.length(), drawn.length(), 1e-12);
}

TEST(DouglasPeucker, TakesAnyNumberUpToAllOfTheSamples) {
  std::vector<TimedPose> samples;
  for (int i = 0; i < 60; ++i) {  // with points repeated
    const double s = 0.1 * (i / 2);
    samples.push_back({0.1 * i, {{s, std::sin(s), 0.0}, Eigen::Quaterniond::Identity()}});
  }
  const Demonstration wave(samples, "arm", "hand", Pose{});
  for (std::size_t nodes = 3; nodes <= 60; ++nodes) {
    const Demonstration fewer = wave.resampled_by_douglas_peucker(nodes);
    ASSERT_EQ(fewer.samples().size(), nodes);
    ASSERT_EQ(fewer.samples().back().time, samples.back().time);
  }
  for (const double tolerance : {0.5, 0.05, 1e-3, 0.0}) {
    const Demonstration fewer = wave.thinned_by_douglas_peucker(tolerance);
    const std::size_t count = fewer.samples().size();
    ASSERT_LE(count, tolerance > 0.0 ? 59u : 60u) << tolerance;
    for (const TimedPose& sample : samples) {
      double nearest = 1e9;
      for (std::size_t k = 1; k < count; ++k) {
        const Eigen::Vector3d& from = fewer.samples()[k - 1].pose.position;
        const Eigen::Vector3d along = fewer.samples()[k].pose.position - from;
        const Eigen::Vector3d offset = sample.pose.position - from;
        const double share =
            std::clamp(along.dot(offset) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
        nearest = std::min(nearest, (offset - share * along).norm());
      }
      ASSERT_LE(nearest, tolerance + 1e-12);
    }
  }
  EXPECT_THROW((void)wave.thinned_by_douglas_peucker(-1e-9), std::invalid_argument);
  EXPECT_THROW((void)wave.thinned_by_douglas_peucker(std::nan("")), std::invalid_argument);
  EXPECT_THROW((void)wave.resampled_by_douglas_peucker(2), std::invalid_argument);
  EXPECT_THROW((void)wave.resampled_by_douglas_peucker(61), std::invalid_argument);
}

const std::string kHead = std::string(kMetadata) + kHeader;

class BadDemonstrationFile : public testing::TestWithParam<std::pair<std::string, std::string>> {};

// Fault 32, 42: demonstration too short, repeated, NaN, time not rising or absurd -> refused
// with file, line and figure
TEST_P(BadDemonstrationFile, IsRefusedWithTheReason) {
  const auto& [text, expected] = GetParam();
  try {
    (void)parsed(text);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("demo.csv"), std::string::npos) << message;
    EXPECT_NE(message.find(expected), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

const std::string kGoodRow = "0,0,0,0,0,0,0,1\n";

INSTANTIATE_TEST_SUITE_P(
    Catalogue, BadDemonstrationFile,
    testing::Values(
        std::pair("", "no header"), std::pair(std::string(kMetadata), "no header"),
        std::pair(kHeader + std::string(kRows), "# frame"),
        std::pair("# frame: arm\n# child_frame: hand\n" + (kHeader + std::string(kRows)),
                  "# target_pose"),
        std::pair("# frame: a\n# frame: b\n", ":2: key 'frame' is given twice"),
        std::pair("# frame:\n# child_frame: h\n# target_pose: 1 0 0 0 0 0 1\n" +
                      (kHeader + std::string(kRows)),
                  "frame is empty"),
        std::pair("# target_pose: 1 2 3\n", ":1: target_pose has 3 numbers, must have 7"),
        std::pair("# target_pose: 1 2 3 0 0 0 1 9\n", "has 8 numbers"),
        std::pair("# target_pose: 1 2 3 0 0 x 1\n", "column 'qz' is 'x'"),
        std::pair("# target_pose: 1 2 3 0 0 0 2\n", "norm 2.0"),
        std::pair("time,x,y,z\n", "header is 'time,x,y,z'"),
        std::pair(kHead, "has 0 samples, must have at least 3"),
        std::pair(kHead + kGoodRow + "1,1,0,0,0,0,0,1\n", "has 2 samples"),
        std::pair(kHead + "0,0,0,0,0,0,0\n", ":5: has 7 columns, must have 8"),
        std::pair(kHead + "0,0,0,0,0,0,0,1,\n", "has 9 columns"),
        std::pair(kHead + "0,0,abc,0,0,0,0,1\n", ":5: column 'y' is 'abc'"),
        std::pair(kHead + "0,0,,0,0,0,0,1\n", "column 'y' is ''"),
        std::pair(kHead + "0,0,1.0m,0,0,0,0,1\n", "column 'y' is '1.0m'"),
        std::pair(kHead + "0,nan,0,0,0,0,0,1\n", "column 'x' is 'nan'"),
        std::pair(kHead + "0,0,0,inf,0,0,0,1\n", "column 'z' is 'inf'"),
        std::pair(kHead + "0,1e999,0,0,0,0,0,1\n", "column 'x' is '1e999'"),
        std::pair(kHead + "0.5,0,0,0,0,0,0,1\n", "column 'time' is 0.5"),
        std::pair(kHead + kGoodRow + "1,1,0,0,0,0,0,1\n1,2,0,0,0,0,0,1\n",
                  ":7: column 'time' is 1.0"),
        std::pair(kHead + "0,0,0,0,0,0,0,0\n", "norm 0.0"),
        std::pair(kHead + "0,0,0,0,0.5,0,0,1\n", "norm 1.1"),
        std::pair(kHead + kGoodRow + "1,0,0,0,0,0,0,1\n2,0,0,0,0,0,0,1\n", "all points repeated"),
        std::pair(kHead + kGoodRow + "1,1,0,0,0,0,0,1\n4e9,2,0,0,0,0,0,1\n",
                  "time 4e+09 s, must be at most 1000000 s"),
        std::pair(kHead + kGoodRow + "1,1e7,0,0,0,0,0,1\n2,0,0,0,0,0,0,1\n", "at most 1000000"),
        std::pair(kHead + std::string("\x01\x02,0,0,0,0,0,0,1\n"), "column 'time' is '?\?'")));

TEST(DemonstrationFile, IsRefusedWhenItCannotBeRead) {
  EXPECT_THROW((void)load_demonstration("/nonexistent/demo.csv"), std::invalid_argument);
  EXPECT_THROW((void)load_demonstration("/"), std::invalid_argument);
}

TEST(Demonstration, IsResampledEquallyAlongTheArcWithTimeKept) {
  const Demonstration resampled = quarter_turn().resampled_by_arc_length(9);
  ASSERT_EQ(resampled.samples().size(), 9u);
  const Eigen::MatrixXd positions = resampled.positions();
  for (std::size_t k = 0; k < 9; ++k) {
    const double along = 0.05 * static_cast<double>(k);
    const TimedPose& sample = resampled.samples()[k];
    const double time = along <= 0.1 ? along / 0.1 : 1.0 + (along - 0.1) / 0.3;
    EXPECT_NEAR(sample.pose.position.x(), std::min(along, 0.1), 1e-12);
    EXPECT_NEAR(sample.pose.position.y(), std::max(along - 0.1, 0.0), 1e-12);
    EXPECT_NEAR(sample.time, time, 1e-9);
    const double turned = sample.pose.orientation.angularDistance(Eigen::Quaterniond::Identity());
    EXPECT_NEAR(turned, std::max(time - 1.0, 0.0) * M_PI / 2.0, 1e-7);
  }
  EXPECT_EQ(resampled.samples().back().pose.position, Eigen::Vector3d(0.1, 0.3, 0.0));
}

TEST(Demonstration, SurvivesStandingStillAtAnyPlace) {
  std::vector<TimedPose> samples;
  for (int i = 0; i < 40; ++i) {
    const double x = 0.1 * std::clamp(i / 5 % 2 == 0 ? i / 10 : i / 10 + 1, 0, 3);
    samples.push_back({0.1 * i, {{x, 0.0, 0.0}, Eigen::Quaterniond::Identity()}});
  }
  const Demonstration resampled =
      Demonstration(samples, "arm", "hand", Pose{}).resampled_by_arc_length(20);
  for (std::size_t k = 1; k < 20; ++k) {
    EXPECT_GT(resampled.samples()[k].time, resampled.samples()[k - 1].time);
  }
  EXPECT_THROW((void)resampled.resampled_by_arc_length(2), std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
