// SPDX-License-Identifier: BSD-3-Clause
#include "path_reach.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>

namespace prf_studies {
namespace {

using arm_kinematics::ArmKinematics;
using arm_kinematics::JointVector;
using Path = std::vector<elte_planner::TimedPose>;

constexpr double kLongestStep = 0.5;     // rad or m of a joint between two samples; more is a jump
constexpr double kRadianInMetres = 0.3;  // for the singular value

double least_singular_value(const ArmKinematics& arm, const JointVector& q) {
  arm_kinematics::Jacobian j = arm.jacobian(q);
  j.bottomRows<3>() *= kRadianInMetres;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd{Eigen::MatrixXd(j)};
  return svd.singularValues().tail<1>()[0];
}

double least_margin(const ArmKinematics& arm, const JointVector& q) {
  return (q - arm.limits().lower).cwiseMin(arm.limits().upper - q).minCoeff();
}

PathReach led_along(const ArmKinematics& arm, const Path& path, const JointVector& begin) {
  PathReach result;
  result.begin = begin;
  result.singular_value = least_singular_value(arm, begin);
  result.margin = least_margin(arm, begin);
  JointVector q = begin;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const auto next = arm.inverse(path[i].pose.isometry(), q, {0, true});
    if (!next.solved || (next.q - q).cwiseAbs().maxCoeff() > kLongestStep) return result;
    const double dt = path[i].time - path[i - 1].time;
    const double share =
        ((next.q - q).cwiseAbs().cwiseQuotient(arm.limits().velocity) / dt).maxCoeff();
    result.speed_share = std::max(result.speed_share, share);
    q = next.q;
    result.singular_value = std::min(result.singular_value, least_singular_value(arm, q));
    result.margin = std::min(result.margin, least_margin(arm, q));
    result.until = path[i].time;
    result.sample = i;
  }
  result.whole = true;
  return result;
}

JointVector drawn(const ArmKinematics& arm, std::mt19937_64* generator) {
  JointVector q = arm.middle();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const auto& limits = arm.limits();
    const double half = std::min(
        M_PI, std::isfinite(limits.upper[i]) ? 0.5 * (limits.upper[i] - limits.lower[i]) : M_PI);
    const double share = static_cast<double>((*generator)() >> 11U) * 0x1.0p-53;
    q[i] += half * (2.0 * share - 1.0);
  }
  return q;
}

bool better(const PathReach& a, const PathReach& b) {
  const auto ease = [](const PathReach& found) {
    return std::min(found.singular_value, kRadianInMetres * found.margin);
  };
  return a.sample != b.sample ? a.sample > b.sample : ease(a) > ease(b);
}

}  // namespace

Path placed_at(const elte_planner::Demonstration& demonstration, const Eigen::Isometry3d& target) {
  const Eigen::Isometry3d moved = target * demonstration.target().isometry().inverse();
  Path path = demonstration.samples();
  for (auto& sample : path) sample.pose = prf_core::pose_from(moved * sample.pose.isometry());
  return path;
}

PathReach path_reach(const ArmKinematics& arm, const Path& path, int draws) {
  std::mt19937_64 generator(1);
  PathReach best;
  for (int draw = 0; draw < draws; ++draw) {
    const auto begin = arm.inverse(path.front().pose.isometry(), drawn(arm, &generator),
                                   {static_cast<std::uint64_t>(draw), false});
    if (!begin.solved) continue;
    const PathReach found = led_along(arm, path, begin.q);
    if (best.begin.size() == 0 || better(found, best)) best = found;
  }
  return best;
}

}  // namespace prf_studies
