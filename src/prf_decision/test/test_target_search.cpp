// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/view/target_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scenario.hpp"

namespace prf_decision {
namespace {

using Eigen::Vector3d;

const Pose kStand = pose_at(0.35, -0.1, 0.5);
const Pose kGoal = pose_at(-0.4, 0, 0);  // so the camera looks along the hand's x axis
const Vector3d kCentre(0.8, 0, 0.5);
const SearchParams kParams{from_seconds(30), 0.4, 1.2, jaco()};

prf_core::TargetPrediction last_seen(const Vector3d& deviations, const Vector3d& velocity) {
  prf_core::TargetPrediction last;
  last.target.pose.position = kCentre;
  last.target.linear_velocity = velocity;
  last.covariance.topLeftCorner<3, 3>() = deviations.cwiseAbs2().asDiagonal();
  return last;
}

// The looks of a hand that is at each of them one tick later; back at the centre ends it.
std::vector<Pose> looks(const prf_core::TargetPrediction& last) {
  TargetSearch search;
  search.begin(kStand, kGoal, last);
  std::vector<Pose> found;
  SearchInput input{from_seconds(1), kStand, std::nullopt, true};
  while (found.size() < 100) {
    const Pose look = search.look(kParams, input);
    if (found.size() > 1 && search.width() == 0) break;
    found.push_back(look);
    input.hand = look;
    input.stamp += kTickPeriod;
  }
  return found;
}

// Direction from the stand to where the camera looks, across the line of sight to the centre.
Vector3d place(const Pose& look) {
  const Vector3d sight = kCentre - kStand.position;
  const Vector3d axis = look.orientation * Vector3d::UnitX();
  const double length = sight.squaredNorm() / axis.dot(sight);
  return (look.position + length * axis - kStand.position).normalized();
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(TargetSearch, LooksFirstWhereTheTargetWasForecast) {
  const auto found = looks(last_seen({0.1, 0.1, 0.1}, {0, 0, 0}));
  EXPECT_LT(angle_between(place(found[0]), kCentre - kStand.position), 1e-5);
}

TEST(TargetSearch, OnlyTurns) {
  for (const Pose& look : looks(last_seen({0.1, 0.2, 0.05}, {0.3, 0, 0}))) {
    EXPECT_EQ(look.position, kStand.position);
  }
}

TEST(TargetSearch, GoesAroundInLoopsThatWiden) {
  const auto found = looks(last_seen({0.1, 0.1, 0.1}, {0, 0, 0}));
  double before = 0;
  for (const Pose& look : found) {
    const double off = angle_between(place(look), kCentre - kStand.position);
    EXPECT_GE(off, before - 1e-5);
    EXPECT_LE(off, kParams.widest + 1e-5);
    before = off;
  }
  EXPECT_GT(before, kParams.widest - kParams.spacing);
}

// Of all that lies within the second loop, a camera that sees `spacing` off its axis sees it once.
TEST(TargetSearch, LeavesNoGapThatACameraOfThatWidthDoesNotSee) {
  const auto found = looks(last_seen({0.1, 0.1, 0.1}, {0, 0, 0}));
  const Vector3d sight = (kCentre - kStand.position).normalized();
  const Vector3d beside = sight.unitOrthogonal();
  for (double off = 0; off <= 2 * kParams.spacing; off += 0.1) {
    for (double azimuth = 0; azimuth < 2 * M_PI; azimuth += 0.2) {
      const Vector3d turned = Eigen::AngleAxisd(azimuth, sight) * beside;
      const Vector3d wanted = std::cos(off) * sight + std::sin(off) * turned;
      double nearest = M_PI;
      for (const Pose& look : found)
        nearest = std::min(nearest, angle_between(place(look), wanted));
      EXPECT_LE(nearest, 0.75 * kParams.spacing) << "at " << off << " rad, azimuth " << azimuth;
    }
  }
}

TEST(TargetSearch, BeginsOnTheSideWhereTheTargetIsLeastCertainAndWent) {
  const Vector3d sight = (kCentre - kStand.position).normalized();
  for (const double sign : {-1.0, 1.0}) {
    const auto found = looks(last_seen({0.02, 0.02, 0.2}, {0, 0, 0.3 * sign}));
    EXPECT_NEAR(angle_between(place(found[1]), sight), kParams.spacing, 1e-6);
    EXPECT_GT(sign * place(found[1]).z(), std::sin(kParams.spacing) - 1e-6);
    // Across it the loop is half as wide.
    double slimmest = M_PI;
    for (std::size_t k = 1; k < 8; ++k) {
      slimmest = std::min(slimmest, angle_between(place(found[k]), sight));
    }
    EXPECT_LT(slimmest, 0.6 * kParams.spacing);
  }
}

TEST(TargetSearch, StaysWithALookUntilTheHandIsThereOrItTakesTooLong) {
  TargetSearch search;
  search.begin(kStand, kGoal, last_seen({0.1, 0.1, 0.1}, {0, 0, 0}));
  const Pose elsewhere{kStand.position,
                       Eigen::Quaterniond(Eigen::AngleAxisd(2, Vector3d::UnitX()))};
  const Stamp begin = from_seconds(1);
  const auto look = [&](Stamp stamp, bool follows) {
    return search.look(kParams, {stamp, elsewhere, std::nullopt, follows}).orientation.coeffs();
  };
  const auto first = look(begin, true);
  EXPECT_EQ(look(begin + TargetSearch::kPatience, true), first);
  const auto second = look(begin + TargetSearch::kPatience + kTickPeriod, true);
  EXPECT_NE(second, first);
  EXPECT_NE(look(begin + TargetSearch::kPatience + 2 * kTickPeriod, false), second);
}

TEST(TargetSearch, LeavesOutWhatTheJointsAreFarFrom) {
  const Eigen::Isometry3d start =
      Eigen::Translation3d(kStand.position) * kStand.orientation.normalized();
  const auto joints = jaco_kinematics::any_inverse(start);
  ASSERT_EQ(joints.status, jaco_kinematics::IkStatus::kSolved);
  TargetSearch search;
  search.begin(kStand, kGoal, last_seen({0.1, 0.1, 0.1}, {0, 0, 0}));
  for (Stamp stamp = from_seconds(1); stamp < from_seconds(2); stamp += kTickPeriod) {
    const Pose look = search.look(kParams, {stamp, std::nullopt, joints.q, false});
    if (search.width() == 0) continue;
    const Eigen::Isometry3d pose = Eigen::Translation3d(look.position) * look.orientation;
    const auto solved = jaco_kinematics::inverse(pose, joints.q);
    EXPECT_EQ(solved.status, jaco_kinematics::IkStatus::kSolved);
    EXPECT_LE((solved.q - joints.q).cwiseAbs().maxCoeff(), TargetSearch::kFarthest);
  }
}

TEST(TargetSearch, NamesAParameterOutOfItsBounds) {
  const auto refused = [](const SearchParams& params) {
    try {
      params.validate();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(kParams), "");
  EXPECT_NE(refused({from_seconds(-1), 0.4, 1.2, jaco()}).find("search[0]"), std::string::npos);
  EXPECT_NE(refused({from_seconds(30), 0.0, 1.2, jaco()}).find("search[1]"), std::string::npos);
  EXPECT_NE(refused({from_seconds(30), 0.4, std::nan(""), jaco()}).find("search[2]"),
            std::string::npos);
}

}  // namespace
}  // namespace prf_decision
