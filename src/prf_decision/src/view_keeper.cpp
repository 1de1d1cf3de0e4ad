// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/view_keeper.hpp"

#include <algorithm>

namespace prf_decision {

void ViewKeeper::set_out(const Pose& hand, const Eigen::Vector3d& target) {
  if (!line_) line_ = Line{hand.orientation, target - hand.position};
}

Eigen::Quaterniond ViewKeeper::orientation_at(const Eigen::Vector3d& position,
                                              const Eigen::Vector3d& target) const {
  const auto turn = Eigen::Quaterniond::FromTwoVectors(line_->sight, target - position);
  return (turn * line_->hand).normalized();
}

void ViewKeeper::arrive(const Eigen::Quaterniond& start, const Eigen::Quaterniond& reached) {
  line_.reset();
  offset_ = (start.conjugate() * reached).normalized();
}

Eigen::Quaterniond ViewKeeper::on_skill(const Eigen::Quaterniond& planned, double fraction) const {
  if (!offset_) return planned;
  const double s = std::clamp(2 * fraction, 0.0, 1.0);
  const double weight = 1 - s * s * (3 - 2 * s);
  return (planned * Eigen::Quaterniond::Identity().slerp(weight, *offset_)).normalized();
}

}  // namespace prf_decision
