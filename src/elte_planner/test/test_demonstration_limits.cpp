// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/demonstration_limits.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace elte_planner {
namespace {

DemonstrationLimits limits() {
  DemonstrationLimits result;
  result.reach = 1.3;
  return result;
}

// 4 s along x at 0.1 m/s, 20 rows each second.
std::vector<TimedPose> rows() {
  std::vector<TimedPose> result;
  for (int i = 0; i <= 80; ++i) {
    result.push_back({0.05 * i, {{0.4 + 0.005 * i, 0.0, 0.3}, Eigen::Quaterniond::Identity()}});
  }
  return result;
}

Demonstration demonstration(const std::vector<TimedPose>& samples, double target = 0.8) {
  return Demonstration(samples, "arm", "hand",
                       Pose{{target, 0.0, 0.5}, Eigen::Quaterniond::Identity()});
}

void expect_refused(const Demonstration& bad, const std::string& expected) {
  try {
    require_executable(bad, limits());
    ADD_FAILURE() << "accepted: " << expected;
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find(expected), std::string::npos) << refusal.what();
  }
}

void expect_refused(const std::string& expected, const std::function<void(TimedPose&)>& spoil,
                    std::size_t first, std::size_t last) {
  std::vector<TimedPose> samples = rows();
  for (std::size_t i = first; i <= last; ++i) spoil(samples[i]);
  expect_refused(demonstration(samples), expected);
}

TEST(DemonstrationLimits, TakeWhatAnArmCanDo) {
  EXPECT_NO_THROW(require_executable(demonstration(rows()), limits()));
  std::vector<TimedPose> turned = rows();  // the same orientation by the other quaternion
  for (std::size_t i = 0; i < turned.size(); i += 2) turned[i].pose.orientation.coeffs() *= -1.0;
  EXPECT_NO_THROW(require_executable(demonstration(turned), limits()));
}

// Fault 48: demonstration out of reach -> refused with row, distance and reach before anything
// moves
TEST(DemonstrationLimits, RefuseRowsOutOfReach) {
  expect_refused(
      "row 81 is 1.35 m from the origin of the planning frame, must be at most 1.3 m",
      [](TimedPose& row) {
        row.pose.position = {1.08, 0.0, 0.81};
      },
      80, 80);
  EXPECT_NO_THROW(require_executable(demonstration(rows()), limits()));
}

// Fault 48: demonstration in mm or ms -> refused with row and figure, and asks for the unit
TEST(DemonstrationLimits, NameUnitsThatAreWrongByAThousand) {
  expect_refused(
      "row 1 is 500 m from the origin of the planning frame, must be at most 1.3 m; is it "
      "in mm?",
      [](TimedPose& row) { row.pose.position *= 1000.0; }, 0, 80);
  expect_refused(
      "row 81 has time 4000 s, must be at most 600 s; is it in ms?",
      [](TimedPose& row) { row.time *= 1000.0; }, 0, 80);
  expect_refused(demonstration(rows(), 800.0), "target_pose is 800 m");
}

// Fault 48: demonstration with a hole -> refused with the row behind it and the distance
TEST(DemonstrationLimits, RefuseAHole) {
  std::vector<TimedPose> samples = rows();
  samples.erase(samples.begin() + 20, samples.begin() + 65);
  expect_refused(demonstration(samples),
                 "row 21 is 0.23 m from the row before, must be at most 0.2");
}

// Fault 48: demonstration with one wild row -> refused with the row and its speed or turning rate
TEST(DemonstrationLimits, RefuseAWildRow) {
  expect_refused(
      "row 31 moves by 0.1001 m in 0.05 s = 2.002 m/s, must be at most 1.5 m/s",
      [](TimedPose& row) { row.pose.position.y() += 0.1; }, 30, 30);
  expect_refused(
      "row 31 turns by 1 rad in 0.05 s = 20 rad/s, must be at most 8 rad/s",
      [](TimedPose& row) {
        row.pose.orientation = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ());
      },
      30, 30);
}

// Fault 28: garbage in the limits of a demonstration -> refused by name, on both sides
TEST(DemonstrationLimits, AreBoundedThemselves) {
  EXPECT_NO_THROW(limits().validate());
  for (double DemonstrationLimits::*const limit :
       {&DemonstrationLimits::reach, &DemonstrationLimits::speed, &DemonstrationLimits::gap,
        &DemonstrationLimits::turning_rate, &DemonstrationLimits::duration,
        &DemonstrationLimits::target}) {
    for (const double bad : {0.0, -1.0, 5e-324, 1e308, std::nan("")}) {
      DemonstrationLimits spoiled = limits();
      spoiled.*limit = bad;
      EXPECT_THROW(spoiled.validate(), std::invalid_argument) << bad;
    }
  }
}

}  // namespace
}  // namespace elte_planner
