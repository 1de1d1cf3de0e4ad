// SPDX-License-Identifier: BSD-3-Clause
// The frames of a URDF's links, each in its parent link.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <unordered_map>
#include <vector>

namespace prf_ros {

struct LinkFrame {
  std::string parent;
  std::string child;
  Eigen::Isometry3d child_in_parent;
};

class FrameTree {
 public:
  // Throws std::invalid_argument if the text is no URDF, has a joint other than fixed, revolute,
  // continuous and prismatic, or numbers beyond the bounds of prf_core/bounds.hpp.
  explicit FrameTree(const std::string& urdf);

  // Links behind fixed joints, in alphabetical order of the joints.
  [[nodiscard]] const std::vector<LinkFrame>& fixed() const { return fixed_; }

  [[nodiscard]] bool is_moving_joint(const std::string& name) const {
    return joints_.count(name) > 0;
  }
  [[nodiscard]] std::vector<std::string> moving_joints() const;  // in alphabetical order

  // Links behind the joints `names` at `positions` (rad or m), in that order. A name that is no
  // moving joint of the model, a position that is not finite, and an entry that only one of the two
  // lists has are left out. Mimic joints need an entry of their own.
  [[nodiscard]] std::vector<LinkFrame> moving(const std::vector<std::string>& names,
                                              const std::vector<double>& positions) const;

 private:
  struct MovingJoint {
    LinkFrame at_zero;     // at joint position 0
    Eigen::Vector3d axis;  // unit, in the child
    bool prismatic;
  };

  std::vector<LinkFrame> fixed_;
  std::unordered_map<std::string, MovingJoint> joints_;
};

}  // namespace prf_ros
