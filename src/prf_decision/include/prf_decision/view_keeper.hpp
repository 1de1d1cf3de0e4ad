// SPDX-License-Identifier: BSD-3-Clause
// Keeps the target in the camera's view on a straight way to the start of the skill, which need not
// look at it. The hand turns as its line of sight to the target does, so that the target stays
// about where it was in the image. At the start the hand is then turned away from the skill by an
// offset; along the skill that fades out until the cursor has come to half of the nodes.
#pragma once

#include <optional>

#include "prf_decision/types.hpp"

namespace prf_decision {

class ViewKeeper {
 public:
  void reset() { *this = ViewKeeper(); }

  // The hand sets out. Without effect when it has already.
  void set_out(const Pose& hand, const Eigen::Vector3d& target);
  [[nodiscard]] bool is_under_way() const { return line_.has_value(); }
  // The orientation that keeps the view from `position`; only under way.
  [[nodiscard]] Eigen::Quaterniond orientation_at(const Eigen::Vector3d& position,
                                                  const Eigen::Vector3d& target) const;
  // The hand has come to the start of the skill, with the orientation `reached`.
  void arrive(const Eigen::Quaterniond& start, const Eigen::Quaterniond& reached);

  // The orientation on the skill where `planned` is demanded, `fraction` 0 .. 1 of the nodes from
  // its start.
  [[nodiscard]] Eigen::Quaterniond on_skill(const Eigen::Quaterniond& planned,
                                            double fraction) const;

 private:
  struct Line {
    Eigen::Quaterniond hand;  // orientation where it set out
    Eigen::Vector3d sight;    // from the hand to the target, m
  };

  std::optional<Line> line_;
  std::optional<Eigen::Quaterniond> offset_;  // at the start: reached = start * offset
};

}  // namespace prf_decision
