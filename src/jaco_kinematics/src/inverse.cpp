// SPDX-License-Identifier: BSD-3-Clause
// The choice of one solution of a pose, of the many that the closed form gives.
//
//   1. Descend from the seed (descent.hpp). A controller's next pose is near, so this nearly
//      always ends at the nearest solution, in about 3 us.
//   2. Otherwise sample the arm angle on the arcs that the limits leave (arm_angle.hpp), with all
//      branches of the closed form at each, and order the candidates by cost.
//   3. Descend from the cheapest candidates and take the cheapest solution.
#include <algorithm>
#include <cmath>
#include <optional>
#include <prf_core/require.hpp>
#include <string>
#include <vector>

#include "arm_angle.hpp"
#include "closed_form.hpp"
#include "descent.hpp"

namespace jaco_kinematics {

namespace {

// [rad] of every joint. Ours: two branches differ by more in some joint, except next to a
// singularity, so a solution within this of the seed is of the seed's branch.
constexpr double kNearSeed = 0.35;
// Added to the cosines of the limits of joints 2 and 6. The arcs neglect the shoulder's offset,
// which turns the upper arm by 1.6 mm / 0.41 m = 0.004 rad at most.
constexpr double kArcSlack = 0.01;
// Ours: solutions among which the cheapest is taken.
constexpr int kCompared = 4;
// Ours: samples of an arc, first few, then more where the few lead to no solution within limits.
constexpr int kNearestSamples[] = {1, 12};
constexpr int kAnySamples[] = {1, 4, 24};

struct Candidate {
  double cost;
  JointVector q;
};

// The circle of the elbow for a pose, with the shoulder's offset neglected. None: out of reach.
std::optional<ElbowCircle> elbow_circle_of(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d wrist = pose.translation() - kToolLength * pose.linear().col(2);
  return elbow_circle(wrist - Eigen::Vector3d(0.0, 0.0, kShoulderHeight), kShoulderOffset);
}

// Arm angle of the seed's elbow on the pose's circle.
double seed_arm_angle(const ElbowCircle& circle, const JointVector& seed) {
  const Frames frames = link_frames(seed);
  const Eigen::Vector3d elbow = frames.origin[3] - frames.origin[1];
  return std::atan2(elbow.dot(circle.axes.ninety), elbow.dot(circle.axes.zero));
}

double nearest_in(const Arc& arc, double phi) {
  const double centre = 0.5 * (arc.begin + arc.end);
  return std::clamp(centre + wrap_angle(phi - centre), arc.begin, arc.end);
}

void add_branches(const Eigen::Isometry3d& pose, double phi, int elbow, const IkCost& cost,
                  std::vector<Candidate>* candidates) {
  for (int branch = 0; branch < kBranches; ++branch) {
    if (elbow_of(branch) != elbow) continue;
    const auto q = branch_solution(pose, phi, branch);
    if (!q) continue;
    const JointVector near = cost.unwrapped(*q);
    candidates->push_back({cost.value(near), near});
  }
}

// On each arc the angle nearest to the seed's, and `samples` more, evenly; cheapest first.
std::vector<Candidate> sample_arcs(const Eigen::Isometry3d& pose, const ElbowCircle& circle,
                                   double seed_phi, const IkCost& cost, int samples) {
  std::vector<Candidate> candidates;
  for (int elbow : {0, 1}) {
    for (const Arc& arc : feasible_arcs(circle, elbow, pose.linear().col(2), kArcSlack)) {
      add_branches(pose, nearest_in(arc, seed_phi), elbow, cost, &candidates);
      for (int i = 0; i < samples; ++i) {
        const double part = (i + 0.5) / samples;
        add_branches(pose, arc.begin + part * (arc.end - arc.begin), elbow, cost, &candidates);
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return candidates;
}

// Of `best` and the first candidates that lead to a solution, the cheapest.
std::optional<JointVector> cheapest_solution(const Eigen::Isometry3d& pose, const IkCost& cost,
                                             const std::vector<Candidate>& candidates,
                                             std::optional<JointVector> best) {
  int found = best ? 1 : 0;
  Frames frames;
  for (const Candidate& candidate : candidates) {
    if (found == kCompared) break;
    JointVector q = candidate.q;
    if (!descend(pose, cost, &q, &frames)) {
      q = candidate.q;
      if (!polish(pose, &q) || !within_limits(q)) continue;
    }
    ++found;
    q = cost.unwrapped(q);
    if (!best || cost.value(q) < cost.value(*best)) best = q;
  }
  return best;
}

// The first branch at one arm angle that lies within limits.
std::optional<JointVector> any_branch(const Eigen::Isometry3d& pose, double phi, int elbow) {
  for (int branch = 0; branch < kBranches; ++branch) {
    if (elbow_of(branch) != elbow) continue;
    auto q = branch_solution(pose, phi, branch);
    if (q && within_limits(*q) && polish(pose, &*q) && within_limits(*q)) return q;
  }
  return std::nullopt;
}

std::optional<JointVector> any_solution(const Eigen::Isometry3d& pose, const ElbowCircle& circle,
                                        int samples) {
  for (const int elbow : {0, 1}) {
    for (const Arc& arc : feasible_arcs(circle, elbow, pose.linear().col(2), kArcSlack)) {
      for (int i = 0; i < samples; ++i) {
        const double phi = arc.begin + (i + 0.5) / samples * (arc.end - arc.begin);
        if (auto q = any_branch(pose, phi, elbow)) return q;
      }
    }
  }
  return std::nullopt;
}

IkResult result_of(IkStatus status, const JointVector& q, const Frames& frames,
                   const Eigen::Isometry3d& pose) {
  const PoseErrors errors = pose_errors(frames, pose);
  return {status, q, arm_angle(frames), errors.position, errors.orientation};
}

IkResult result_of(IkStatus status, const JointVector& q, const Eigen::Isometry3d& pose) {
  return result_of(status, q, link_frames(q), pose);
}

}  // namespace

void IkParams::validate() const {
  using prf_core::require_between;
  for (int i = 0; i < 7; ++i) {
    require_between("weight[" + std::to_string(i) + "]", weight[i], 1e-3, 1e3);
  }
  require_between("limit_margin", limit_margin, 1e-3, kPi, "rad");
  require_between("limit_weight", limit_weight, 0.0, 1e3, "rad^2");
}

IkResult inverse(const Eigen::Isometry3d& pose, const JointVector& seed, const IkParams& params) {
  params.validate();
  check_angles(seed, "seed");
  const Eigen::Isometry3d target = checked_pose(pose);
  const IkCost cost(seed, params);

  JointVector near = seed;
  Frames frames;
  const bool solved = descend(target, cost, &near, &frames);
  if (solved && (near - seed).cwiseAbs().maxCoeff() < kNearSeed) {
    return result_of(IkStatus::kSolved, near, frames, target);
  }

  const auto circle = elbow_circle_of(target);
  if (!circle) return result_of(IkStatus::kOutOfReach, seed, target);
  const double seed_phi = seed_arm_angle(*circle, seed);
  std::optional<JointVector> first;
  if (solved) first = cost.unwrapped(near);
  for (const int samples : kNearestSamples) {
    const auto candidates = sample_arcs(target, *circle, seed_phi, cost, samples);
    const auto q = cheapest_solution(target, cost, candidates, first);
    if (q) return result_of(IkStatus::kSolved, *q, target);
  }
  return result_of(IkStatus::kNoSolutionWithinLimits, seed, target);
}

IkResult any_inverse(const Eigen::Isometry3d& pose) {
  const Eigen::Isometry3d target = checked_pose(pose);
  const auto circle = elbow_circle_of(target);
  const JointVector straight = JointVector::Constant(kPi);
  if (!circle) return result_of(IkStatus::kOutOfReach, straight, target);
  for (const int samples : kAnySamples) {
    if (const auto q = any_solution(target, *circle, samples)) {
      return result_of(IkStatus::kSolved, normalized_angles(*q), target);
    }
  }
  return result_of(IkStatus::kNoSolutionWithinLimits, straight, target);
}

}  // namespace jaco_kinematics
