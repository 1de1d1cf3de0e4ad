// SPDX-License-Identifier: BSD-3-Clause
#include "arm_kinematics/chain_kinematics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <prf_core/bounds.hpp>
#include <random>
#include <utility>

#include "bounded_step.hpp"
#include "task_error.hpp"

namespace arm_kinematics {
namespace {

// Ours; kinematics_benchmark says what they achieve.
constexpr double kTolerance = 1e-9;      // m, rad
constexpr int kMaxStarts = 60;           // the seed, and random ones
constexpr int kMaxIterations = 60;       // from one start
constexpr int kPatience = 4;             // iterations in which the error has to halve
constexpr double kDamping = 0.05;        // c in lambda = c e^T W e
constexpr double kLeastDamping = 1e-12;  // keeps the matrix positive definite
constexpr double kLargestStep = 1.0;     // rad or m, of a joint in one iteration
constexpr double kTurn = 2.0 * M_PI;

struct Search {
  const ArmKinematics& arm;
  const Eigen::Isometry3d& pose;
  Twist weight;  // 1/m, 1/rad: makes both parts of the error about as large

  // Whether q ends at the pose; q is within limits in any case.
  bool descend(JointVector* q, PoseError* error) const;
};

bool Search::descend(JointVector* q, PoseError* error) const {
  const JointLimits& limits = arm.limits();
  double best = INFINITY;
  int since_best = 0;
  for (int i = 0; i < kMaxIterations; ++i) {
    const TaskError now = task_error(arm.placement(*q), pose, arm.task());
    *error = size_of(now);
    if (error->position < kTolerance && error->orientation < kTolerance) return true;
    const Twist e = now.value.cwiseProduct(weight);
    const double size = e.squaredNorm();
    if (size < 0.5 * best) {
      best = size;
      since_best = 0;
    } else if (++since_best > kPatience) {
      return false;
    }
    const Jacobian a = weight.asDiagonal() * now.jacobian;
    JointMatrix h = a.transpose() * a;
    h.diagonal().array() += kDamping * size + kLeastDamping;
    const JointVector room = JointVector::Constant(q->size(), kLargestStep);
    const auto step =
        bounded_step(h, a.transpose() * e, (limits.lower - *q).cwiseMax(-room).cwiseMin(0.0),
                     (limits.upper - *q).cwiseMin(room).cwiseMax(0.0));
    if (!step) return false;
    *q += *step;
    *q = q->cwiseMax(limits.lower).cwiseMin(limits.upper);
  }
  return false;
}

// Joints uniform within limits; a continuous one within half a turn of the seed.
JointVector drawn(const JointLimits& limits, const JointVector& seed, std::mt19937_64* generator) {
  JointVector q = seed;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const bool bounded = std::isfinite(limits.lower[i]);
    const double lower = bounded ? limits.lower[i] : seed[i] - M_PI;
    const double upper = bounded ? limits.upper[i] : seed[i] + M_PI;
    // 53 bits; the same numbers with every standard library, unlike uniform_real_distribution.
    const double share = static_cast<double>((*generator)() >> 11U) * 0x1.0p-53;
    q[i] = lower + share * (upper - lower);
  }
  return q;
}

// Whole turns that bring the joint nearest to the seed within its limits.
double in_turn_of(double q, double seed, double lower, double upper) {
  const double near = seed + std::remainder(q - seed, kTurn);
  for (double turned : {near, near + kTurn, near - kTurn}) {
    const bool nearer = std::abs(turned - seed) < std::abs(q - seed);
    if (nearer && turned >= lower && turned <= upper) q = turned;
  }
  return q;
}

double length_of(const Chain& chain) {
  double length = chain.tip.translation().norm();
  for (std::size_t i = 1; i < chain.joints.size(); ++i) {
    length += chain.joints[i].origin.translation().norm();
  }
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    if (!chain.joints[i].prismatic) continue;
    const auto joint = static_cast<Eigen::Index>(i);
    length += std::max(std::abs(chain.limits.lower[joint]), std::abs(chain.limits.upper[joint]));
  }
  return length;
}

}  // namespace

ChainKinematics::ChainKinematics(Chain chain)
    : chain_(std::move(chain)), reach_(length_of(chain_)) {}

Placement ChainKinematics::placement(const JointVector& q) const {
  require_joints(q, "q");
  Placement result;
  result.jacobian.resize(6, q.size());
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, kMaxJoints> at;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const ChainJoint& joint = chain_.joints[static_cast<std::size_t>(i)];
    place += turn * joint.origin.translation();
    turn = (turn * joint.origin.linear()).eval();
    const Eigen::Vector3d axis = turn.col(2);
    if (joint.prismatic) {
      result.jacobian.col(i) << axis, Eigen::Vector3d::Zero();
      place += q[i] * axis;
      continue;
    }
    at[static_cast<std::size_t>(i)] = place;
    result.jacobian.col(i).tail<3>() = axis;
    const double c = std::cos(q[i]);
    const double s = std::sin(q[i]);
    const Eigen::Vector3d x = turn.col(0);
    turn.col(0) = c * x + s * turn.col(1);
    turn.col(1) = c * turn.col(1) - s * x;
  }
  result.tip.translation() = place + turn * chain_.tip.translation();
  result.tip.linear() = turn * chain_.tip.linear();
  result.tip.makeAffine();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    if (chain_.joints[joint].prismatic) continue;
    const Eigen::Vector3d axis = result.jacobian.col(i).tail<3>();
    result.jacobian.col(i).head<3>() = axis.cross(result.tip.translation() - at[joint]);
  }
  return result;
}

Eigen::Isometry3d ChainKinematics::forward(const JointVector& q) const { return placement(q).tip; }

IkResult ChainKinematics::inverse(const Eigen::Isometry3d& pose, const JointVector& seed,
                                  const IkSearch& options) const {
  prf_core::require_within("pose", pose.matrix(), prf_core::kMaxPosition, "m");
  require_joints(seed, "seed");
  IkResult unsolved{false, seed, error_between(forward(seed), pose, task())};
  const Eigen::Vector3d first = chain_.joints.front().origin.translation();
  if (!((pose.translation() - first).norm() < reach_)) return unsolved;

  Search search{*this, pose, Twist::Ones()};
  search.weight.head<3>() /= 0.5 * reach_;
  std::mt19937_64 generator(options.draws);
  JointVector q = seed.cwiseMax(limits().lower).cwiseMin(limits().upper);
  for (int start = 0; start < (options.nearest ? 1 : kMaxStarts); ++start) {
    IkResult result;
    if (search.descend(&q, &result.error)) {
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        if (chain_.joints[static_cast<std::size_t>(i)].prismatic) continue;
        q[i] = in_turn_of(q[i], seed[i], limits().lower[i], limits().upper[i]);
      }
      return {true, q, result.error};
    }
    q = drawn(limits(), seed, &generator);
  }
  return unsolved;
}

}  // namespace arm_kinematics
