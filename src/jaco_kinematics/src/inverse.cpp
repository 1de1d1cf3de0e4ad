// SPDX-License-Identifier: BSD-3-Clause
// Choice among the solutions of a pose.
//   cost(q) = sum_i w_i (q_i - seed_i)^2 + limit_weight sum_{2,4,6} max(0, 1 - d_i /
//   limit_margin)^2
// First the seed's own neighbourhood: Newton to the pose with the self-motion that lowers the cost,
// pulled null_space_step farther to a better posture.
// It passes the shoulder's singularity, where the arm angle's branches exchange. If that does not
// end close by within limits, the closed form is sampled on the feasible arcs of every branch, and
// the cheapest are refined.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "arm_angle.hpp"
#include "closed_form.hpp"
#include "pose_step.hpp"

namespace jaco_kinematics {

namespace {

class Cost {
 public:
  Cost(const JointVector& seed, const IkParams& options) : seed_(seed), options_(options) {}

  double value(const JointVector& q) const {
    double sum = (q - seed_).cwiseAbs2().dot(options_.weight);
    for (int i : {1, 3, 5}) {
      const double depth = limit_depth(q, i);
      sum += options_.limit_weight * depth * depth;
    }
    return sum;
  }

  // How far to go from q along a direction of self-motion: Newton's step to the least cost, and
  // null_space_step or less toward a better posture.
  double self_motion(const JointVector& q, const JointVector& direction) const {
    JointVector descent = options_.weight.cwiseProduct(seed_ - q);
    double curvature = direction.cwiseAbs2().dot(options_.weight);
    for (int i : {1, 3, 5}) {
      const double depth = limit_depth(q, i);
      if (depth == 0.0) continue;
      const double inward = q[i] < kPi ? 1.0 : -1.0;
      const double slope = direction[i] / options_.limit_margin;
      descent[i] += inward * options_.limit_weight * depth / options_.limit_margin;
      curvature += options_.limit_weight * slope * slope;
    }
    double length = direction.dot(descent) / curvature;
    const double pull = null_space_gradient(q, direction);
    length += options_.null_space_step * pull / std::hypot(pull, kGentlePull);
    return length;
  }

  // Continuous joints in the turn nearest to the seed.
  JointVector unwrapped(const JointVector& q) const {
    JointVector result = normalized_angles(q);
    for (int i : {0, 2, 4, 6}) result[i] = seed_[i] + wrap_angle(q[i] - seed_[i]);
    return result;
  }

 private:
  // 0 at the margin and inside it, 1 at the limit; the limits are symmetric about pi.
  double limit_depth(const JointVector& q, int joint) const {
    const double distance = jaco_joint_limits().upper[joint] - kPi - std::abs(q[joint] - kPi);
    return std::max(0.0, 1.0 - distance / options_.limit_margin);
  }

  // Joints 2 and 6 away from limits and from their singularity at pi: each 0 from the margin on, at
  // most 1. (Joint 4 does not depend on the self-motion.)
  double null_space_gradient(const JointVector& q, const JointVector& direction) const {
    constexpr double kPeak = 2.598;  // 1 / max of u (1 - u^2)
    double pull = 0.0;
    for (int i : {1, 5}) {
      const double from_pi = q[i] - kPi;
      const double to_limit = jaco_joint_limits().upper[i] - kPi - std::abs(from_pi);
      const double u = from_pi / options_.null_space_margin;
      const double away = std::abs(u) < 1.0 ? kPeak * u * (1.0 - u * u) : 0.0;
      const double depth = std::clamp(1.0 - to_limit / options_.null_space_margin, 0.0, 1.0);
      pull += direction[i] * (away - std::copysign(depth, from_pi));
    }
    return pull;
  }

  static constexpr double kGentlePull = 0.03;  // below this the step becomes smaller
  JointVector seed_;
  IkParams options_;
};

// `length` changed so little that q + length * direction keeps joints 2, 4, 6 within limits.
double limited_length(const JointVector& q, const JointVector& direction, double length) {
  constexpr double kInset = 1e-7;  // [rad], for the polish that follows
  constexpr double kStill = 1e-6;
  const JointLimits& limits = jaco_joint_limits();
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  for (int i : {1, 3, 5}) {
    if (std::abs(direction[i]) < kStill) continue;
    const double a = (limits.lower[i] + kInset - q[i]) / direction[i];
    const double b = (limits.upper[i] - kInset - q[i]) / direction[i];
    least = std::max(least, std::min(a, b));
    most = std::min(most, std::max(a, b));
  }
  return least <= most ? std::clamp(length, least, most) : length;
}

// Sequential quadratic steps on min cost(q) subject to forward(q) = pose and the limits; when the
// self-motion has settled, Newton alone. `frames` become those of q.
bool descend(const Eigen::Isometry3d& pose, const Cost& cost, JointVector* q, Frames* frames) {
  constexpr int kDescents = 10;
  constexpr int kIterations = 22;
  constexpr double kSettled = 1e-4;     // [rad]; the next step is a tenth or less
  constexpr double kLargestStep = 0.3;  // [rad] in the norm of q
  bool settled = false;
  for (int i = 0; i < kIterations; ++i) {
    *frames = link_frames(*q);
    const auto difference = pose_difference(frames->end_effector, pose);
    if (settled && difference.norm() < kPoseGoal) return within_limits(*q);
    auto [step, direction] = pose_step(*frames, difference);
    if (step.norm() > kLargestStep) step *= kLargestStep / step.norm();
    if (!settled) {
      const JointVector moved = *q + step;
      const double wanted = cost.self_motion(moved, direction);
      const double length =
          std::clamp(limited_length(moved, direction, wanted), -kLargestStep, kLargestStep);
      step += length * direction;
      settled = i + 1 == kDescents || std::abs(length) < kSettled;
    }
    *q += step;
  }
  *frames = link_frames(*q);
  return pose_errors(*frames, pose).met() && within_limits(*q);
}

struct Candidate {
  double cost;
  JointVector q;
};

void add_branches(const Eigen::Isometry3d& pose, double phi, int elbow, const Cost& cost,
                  std::vector<Candidate>* candidates) {
  for (int branch = 0; branch < kBranches; ++branch) {
    if (elbow_of(branch) != elbow) continue;
    const auto q = branch_solution(pose, phi, branch);
    if (!q) continue;
    const JointVector near = cost.unwrapped(*q);
    candidates->push_back({cost.value(near), near});
  }
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

// On each feasible arc the angle nearest to the seed's, and `samples` more, evenly.
std::vector<Candidate> sample_arcs(const Eigen::Isometry3d& pose, const ElbowCircle& circle,
                                   double seed_phi, const Cost& cost, int samples) {
  constexpr double kSlack = 0.01;  // covers the shoulder's offset, which the arcs neglect
  std::vector<Candidate> candidates;
  for (int elbow : {0, 1}) {
    for (const Arc& arc : feasible_arcs(circle, elbow, pose.linear().col(2), kSlack)) {
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
std::optional<JointVector> best_solution(const Eigen::Isometry3d& pose, const Cost& cost,
                                         const std::vector<Candidate>& candidates,
                                         std::optional<JointVector> best) {
  constexpr int kCompared = 4;
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
  for (int i = 0; i < 7; ++i) {
    if (!(std::isfinite(weight[i]) && weight[i] > 0.0)) {
      throw std::invalid_argument("weight[" + std::to_string(i) +
                                  "] = " + std::to_string(weight[i]) + " must be above 0");
    }
  }
  if (!(std::isfinite(limit_margin) && limit_margin > 0.0)) {
    throw std::invalid_argument("limit_margin = " + std::to_string(limit_margin) +
                                " rad must be above 0");
  }
  if (!(std::isfinite(limit_weight) && limit_weight >= 0.0)) {
    throw std::invalid_argument("limit_weight = " + std::to_string(limit_weight) +
                                " rad^2 must not be below 0");
  }
  if (!(std::isfinite(null_space_margin) && null_space_margin > 0.0)) {
    throw std::invalid_argument("null_space_margin = " + std::to_string(null_space_margin) +
                                " rad must be above 0");
  }
  if (!(std::isfinite(null_space_step) && null_space_step >= 0.0)) {
    throw std::invalid_argument("null_space_step = " + std::to_string(null_space_step) +
                                " rad must not be below 0");
  }
}

IkResult inverse(const Eigen::Isometry3d& pose, const JointVector& seed, const IkParams& options) {
  constexpr double kNear = 0.35;  // [rad] of any joint
  options.validate();
  check_finite(seed, "seed");
  const Eigen::Isometry3d target = checked_pose(pose);
  const Cost cost(seed, options);

  JointVector near = seed;
  Frames frames;
  const bool met = descend(target, cost, &near, &frames);
  if (met && (near - seed).cwiseAbs().maxCoeff() < kNear) {
    return result_of(IkStatus::kSolved, near, frames, target);
  }

  const Eigen::Vector3d wrist = target.translation() - kToolLength * target.linear().col(2);
  const auto circle =
      elbow_circle(wrist - Eigen::Vector3d(0.0, 0.0, kShoulderHeight), kShoulderOffset);
  if (!circle) return result_of(IkStatus::kOutOfReach, seed, target);

  const double seed_phi = seed_arm_angle(*circle, seed);
  std::optional<JointVector> first;
  if (met) first = cost.unwrapped(near);
  for (const int samples : {1, 12}) {
    const auto candidates = sample_arcs(target, *circle, seed_phi, cost, samples);
    const auto q = best_solution(target, cost, candidates, first);
    if (q) return result_of(IkStatus::kSolved, *q, target);
  }
  return result_of(IkStatus::kNoSolutionWithinLimits, seed, target);
}

IkResult any_inverse(const Eigen::Isometry3d& pose) {
  constexpr double kSlack = 0.01;  // as in sample_arcs
  const Eigen::Isometry3d target = checked_pose(pose);
  const Eigen::Vector3d wrist = target.translation() - kToolLength * target.linear().col(2);
  const auto circle =
      elbow_circle(wrist - Eigen::Vector3d(0.0, 0.0, kShoulderHeight), kShoulderOffset);
  const JointVector straight = JointVector::Constant(kPi);
  if (!circle) return result_of(IkStatus::kOutOfReach, straight, target);
  for (const int samples : {1, 4, 24}) {
    for (const int elbow : {0, 1}) {
      for (const Arc& arc : feasible_arcs(*circle, elbow, target.linear().col(2), kSlack)) {
        for (int i = 0; i < samples; ++i) {
          const double phi = arc.begin + (i + 0.5) / samples * (arc.end - arc.begin);
          for (int branch = 0; branch < kBranches; ++branch) {
            if (elbow_of(branch) != elbow) continue;
            auto q = branch_solution(target, phi, branch);
            if (q && within_limits(*q) && polish(target, &*q) && within_limits(*q)) {
              return result_of(IkStatus::kSolved, normalized_angles(*q), target);
            }
          }
        }
      }
    }
  }
  return result_of(IkStatus::kNoSolutionWithinLimits, straight, target);
}

}  // namespace jaco_kinematics
