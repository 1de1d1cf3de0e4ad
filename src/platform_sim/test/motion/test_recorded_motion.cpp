// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/recorded_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "motion/body_motion.hpp"
#include "temporary_file.hpp"

namespace platform_sim {
namespace {

// sin 2t and t^2/50 at uneven times from 5 s on.
std::string recording(double duration) {
  std::ostringstream text;
  text.precision(12);
  text << "# made for a test\ntime,wave,curve\n";
  for (int i = 0; i <= static_cast<int>(duration * 50); ++i) {
    const double t = 0.02 * i + (i % 2 == 0 ? 0.0 : 0.004);
    text << 5.0 + t << "," << std::sin(2.0 * t) << "," << t * t / 50.0 << "\n";
  }
  return text.str();
}

TEST(RecordedMotion, PlaysTheRecordingForwardAndBackward) {
  const TemporaryFile file(recording(6.0), ".csv");
  const RecordedMotion motion(file.path());
  EXPECT_EQ(motion.columns(), (std::vector<std::string>{"wave", "curve"}));
  // Rising takes 1 s for half a second of the recording; a pass takes 6 + 1 s.
  for (double time = 1.0; time < 6.0; time += 0.173) {
    const double place = time - 0.5;
    EXPECT_NEAR(motion.at(time).values[0], std::sin(2.0 * place), 1e-5) << time;
    EXPECT_NEAR(motion.at(time).velocities[0], 2.0 * std::cos(2.0 * place), 1e-3) << time;
    EXPECT_NEAR(motion.at(time).values[1], place * place / 50.0, 1e-5) << time;
    EXPECT_NEAR(motion.at(14.0 - time).values[0], motion.at(time).values[0], 1e-12);
    EXPECT_NEAR(motion.at(14.0 + time).values[0], motion.at(time).values[0], 1e-9);
    EXPECT_NEAR(motion.at(14.0 - time).velocities[0], -motion.at(time).velocities[0], 1e-9);
  }
}

TEST(RecordedMotion, RestsAtItsFirstRowAndAtEachTurn) {
  const TemporaryFile file(recording(6.0), ".csv");
  const RecordedMotion motion(file.path());
  for (const double time : {-3.0, 0.0, 7.0, 14.0}) {
    EXPECT_LT(motion.at(time).velocities.norm(), 1e-9) << time;
  }
  EXPECT_EQ(motion.at(-3.0).values[0], 0.0);
}

TEST(RecordedMotion, PositionVelocityAndAccelerationAreContinuous) {
  const TemporaryFile file(recording(3.0), ".csv");
  const RecordedMotion motion(file.path());
  constexpr double kStep = 1e-4;
  Eigen::VectorXd last_acceleration = Eigen::VectorXd::Zero(2);
  for (double time = 0.5 * kStep; time < 9.0; time += kStep) {
    const RecordedMotion::Sample before = motion.at(time - kStep), after = motion.at(time + kStep);
    const RecordedMotion::Sample now = motion.at(time);
    const Eigen::VectorXd slope = (after.values - before.values) / (2.0 * kStep);
    ASSERT_LT((slope - now.velocities).norm(), 1e-5) << time;
    const Eigen::VectorXd acceleration = (after.velocities - before.velocities) / (2.0 * kStep);
    ASSERT_LT((acceleration - last_acceleration).norm(), 0.05) << time;
    last_acceleration = acceleration;
  }
}

TEST(RecordedMotion, TellsItsExtremes) {
  const TemporaryFile file(recording(6.0), ".csv");
  const RecordedMotion::Extremes most = RecordedMotion(file.path()).extremes();
  EXPECT_NEAR(most.value[0], 1.0, 1e-3);
  EXPECT_NEAR(most.least[0], -1.0, 1e-3);
  EXPECT_NEAR(most.velocity[0], 2.0, 1e-2);
  EXPECT_NEAR(most.acceleration[0], 4.0, 0.1);
}

// Fault 43, 52: values or steps of time beyond physical bounds, endless files -> refused with row
TEST(RecordedMotion, RefusesWhatNoRecordingHolds) {
  const std::vector<std::pair<std::string, std::string>> faults{
      {"time,a\n0,1\n0.5,1e308\n1,1\n2,1\n", "line 3: a = 1e308"},
      {"time,a\n0,1\n0.5,-1e5\n1,1\n2,1\n", "line 3: a = -1e5"},
      {"time,a\n0,1\n1e-9,1\n1,1\n2,1\n", "line 3: time = 1e-9, must be 0.0001 .. 2 s after"},
      {"time,a\n0,1\n0.5,1\n100,1\n200,1\n", "line 4: time = 100, must be 0.0001 .. 2 s after"},
      {"time,a\n1e300,1\n2e300,1\n3e300,1\n4e300,1\n", "line 2: time = 1e300"},
  };
  for (const auto& [text, complaint] : faults) {
    const TemporaryFile file(text, ".csv");
    const std::string said = refusal([&] { RecordedMotion motion(file.path()); });
    EXPECT_NE(said.find(complaint), std::string::npos) << said;
  }
  for (const std::string path : {"/dev/zero", "/tmp"}) {
    EXPECT_NE(refusal([&] { RecordedMotion motion(path); }).find("must be a file"),
              std::string::npos);
  }
}

TEST(RecordedMotion, RefusesBadFilesAndSaysWhere) {
  const std::vector<std::pair<std::string, std::string>> faults{
      {"time,a\n0,1\n0.5,nan\n1,1\n2,1\n", "line 3: a = \"nan\", must be a finite number"},
      {"time,a\n0,1\n0.5,x\n1,1\n2,1\n", "line 3: a = \"x\", must be a finite number"},
      {"time,a\n0,1\n0.5,1\n0.5,1\n2,1\n", "line 4: time = 0.5, must be above the row before's"},
      {"time,a\n0,1\n0.5\n1,1\n2,1\n", "line 3: 1 values, must be 2"},
      {"# none\nt_s,a\n0,1\n", "line 2: the header is \"t_s,a\", must be time,<name>,..."},
      {"time\n0\n", "line 1: the header is \"time\", must be time,<name>,..."},
      {"time,a\n0,1\n0.2,1\n0.4,1\n0.6,1\n", "too short"},
      {"", "is empty"},
  };
  for (const auto& [text, complaint] : faults) {
    const TemporaryFile file(text, ".csv");
    const std::string said = refusal([&] { RecordedMotion motion(file.path()); });
    EXPECT_NE(said.find(complaint), std::string::npos) << said;
    EXPECT_NE(said.find(file.path()), std::string::npos) << said;
  }
  EXPECT_NE(refusal([] { RecordedMotion motion("absent.csv"); }).find("there is no such file"),
            std::string::npos);
}

std::string body_recording(const std::string& header, const std::string& row) {
  std::string text = header + "\n";
  for (const char* time : {"0", "0.5", "1", "1.5"}) text += std::string(time) + "," + row + "\n";
  return text;
}

TEST(BodyMotion, IsAPoseInThePlatformFrame) {
  const TemporaryFile file(
      body_recording("time,x,y,z,roll,pitch,yaw", "-0.1,0.05,0.52,0.01,0.02,0.3"), ".csv");
  const Eigen::Isometry3d base = BodyMotion(file.path()).base_in_platform(0.7);
  EXPECT_TRUE(base.translation().isApprox(Eigen::Vector3d(-0.1, 0.05, 0.52)));
  EXPECT_NEAR(-std::asin(base.linear()(2, 0)), 0.02, 1e-12);
  EXPECT_NEAR(std::atan2(base.linear()(1, 0), base.linear()(0, 0)), 0.3, 1e-12);
  EXPECT_NEAR(std::atan2(base.linear()(2, 1), base.linear()(2, 2)), 0.01, 1e-12);
}

TEST(BodyMotion, RefusesOtherColumnsAndPosesOutOfBounds) {
  const std::string header = "time,x,y,z,roll,pitch,yaw";
  const std::vector<std::pair<std::string, std::string>> faults{
      {body_recording("time,x,y,z,roll,pitch,turn", "0,0,0.5,0,0,0"), "header must be"},
      {body_recording(header, "1.5,0,0.5,0,0,0"), "largest x = 1.5, must be within [0, 1]"},
      {body_recording(header, "0,0,0.5,0,0.8,0"), "largest pitch = 0.8, must be within [0, 0.7]"},
      {body_recording(header, "0,0,0.1,0,0,0"), "lowest z = 0.1"},
  };
  for (const auto& [text, complaint] : faults) {
    const TemporaryFile file(text, ".csv");
    const std::string said = refusal([&] { BodyMotion motion(file.path()); });
    EXPECT_NE(said.find(complaint), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace platform_sim
