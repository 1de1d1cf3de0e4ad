// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/view/target_search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <stdexcept>

#include "prf_decision/view_keeper.hpp"

namespace prf_decision {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

bool is_in_reach(const arm_kinematics::ArmKinematics& arm, const Pose& hand,
                 const std::optional<arm_kinematics::JointVector>& joints) {
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(hand.position) * hand.orientation.normalized();
  if (!joints) return arm.reaches(pose);
  const auto found = arm.inverse(pose, *joints);
  return found.solved && (found.q - *joints).cwiseAbs().maxCoeff() <= TargetSearch::kFarthest;
}

// The looks of a loop: as far apart as its radius and the spacing say.
int places(double spacing, int loop) {
  return std::max(1, static_cast<int>(std::ceil(2 * M_PI * std::sin(loop * spacing) / spacing)));
}

}  // namespace

void SearchParams::validate() const {
  using prf_core::require_between;
  require_between("search[0]", to_seconds(time), 0, 600, "s");
  require_between("search[1]", spacing, 0.05, 1, "rad");
  require_between("search[2]", widest, 0, 1.4, "rad");
  if (!arm) throw std::invalid_argument("the search needs an arm");
}

void TargetSearch::begin(const Pose& stand, const Pose& goal_in_target,
                         const prf_core::TargetPrediction& last) {
  const Vector3d sight = last.target.pose.position - stand.position;
  centre_ = {stand.position, looking_along(stand.orientation, sight, goal_in_target)};
  sight_ = sight.norm() > 0 ? sight.normalized() : stand.orientation * Vector3d::UnitZ();
  distance_ = sight.norm();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - sight_ * sight_.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(across * last.position_covariance() *
                                                            across);
  const bool is_known =
      axes.info() == Eigen::Success && axes.eigenvalues().allFinite() && axes.eigenvalues()[2] > 0;
  major_ = is_known ? Vector3d(across * axes.eigenvectors().col(2)).normalized()
                    : sight_.unitOrthogonal();
  const double ratio =
      is_known ? std::max(axes.eigenvalues()[1], 0.0) / axes.eigenvalues()[2] : 1.0;
  slimness_ = std::clamp(std::sqrt(ratio), kSlimmest, 1.0);
  // The target went on where it was going: that end of the axis comes first.
  if (major_.dot(last.target.linear_velocity) < 0) major_ = -major_;
  look_ = {};
  since_.reset();
  wanted_ = centre_;
  width_ = 0;
}

double TargetSearch::angle_of(const SearchParams& params, const Look& look) const {
  const double theta = 2 * M_PI * look.place / places(params.spacing, look.loop);
  return look.loop * params.spacing * std::hypot(std::cos(theta), slimness_ * std::sin(theta));
}

Pose TargetSearch::pose_of(const SearchParams& params, const Look& look) const {
  const double theta = 2 * M_PI * look.place / places(params.spacing, look.loop);
  const Vector3d toward = std::cos(theta) * major_ + std::sin(theta) * sight_.cross(major_);
  const double off = distance_ * std::tan(angle_of(params, look));
  const Vector3d along = distance_ * sight_ + off * toward;
  const Quaterniond turn = Quaterniond::FromTwoVectors(sight_, along);
  return {centre_.position, (turn * centre_.orientation).normalized()};
}

TargetSearch::Look TargetSearch::after(const SearchParams& params, const Look& look) const {
  if (look.place + 1 < places(params.spacing, look.loop)) return {look.loop, look.place + 1};
  const bool is_widest = (look.loop + 1) * params.spacing > params.widest + 1e-9;
  return is_widest ? Look{} : Look{look.loop + 1, 0};
}

// At most once around: where nothing is in reach, the hand looks at the centre.
void TargetSearch::go_on(const SearchParams& params, const SearchInput& input) {
  do {
    look_ = after(params, look_);
    wanted_ = pose_of(params, look_);
  } while ((look_.loop > 0 || look_.place > 0) && !is_in_reach(*params.arm, wanted_, input.joints));
  width_ = angle_of(params, look_);
  since_ = input.stamp;
}

Pose TargetSearch::look(const SearchParams& params, const SearchInput& input) {
  if (!since_) since_ = input.stamp;
  const bool is_there = input.hand &&
                        input.hand->orientation.angularDistance(wanted_.orientation) <= kThere &&
                        (input.hand->position - wanted_.position).norm() <= kNear;
  if (is_there || !input.follows || input.stamp - *since_ > kPatience) go_on(params, input);
  return wanted_;
}

}  // namespace prf_decision
