// SPDX-License-Identifier: BSD-3-Clause
//
// One demonstration of a skill: timed poses of the hand in the planning frame, together with where
// the target was while it was recorded.
//
// CSV form, read by load_demonstration():
//   # frame: j2s7s300_link_base                 frame of all poses
//   # child_frame: j2s7s300_end_effector        the frame that was guided
//   # target_pose: x y z qx qy qz qw            target in `frame`, m and unit quaternion
//   time,x,y,z,qx,qy,qz,qw                      s from 0 and strictly rising, m, unit quaternion
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <istream>
#include <string>
#include <vector>

namespace elte_planner {

struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  Eigen::Isometry3d transform() const;
  bool is_finite() const { return position.allFinite() && orientation.coeffs().allFinite(); }
};

Pose pose_from(const Eigen::Isometry3d& transform);

struct TimedPose {
  double time = 0.0;  // s from the start
  Pose pose;
};

// Always valid: the constructor throws std::invalid_argument naming sample, value and bound.
class Demonstration {
 public:
  static constexpr std::size_t kMinSamples = 3;
  static constexpr double kQuaternionTolerance = 1e-3;  // on the norm; within it, renormalised
  static constexpr double kMinLength = 1e-6;            // m of path
  static constexpr double kMaxCoordinate = 1e6;         // m

  Demonstration(std::vector<TimedPose> samples, std::string frame, std::string child_frame,
                const Pose& target);

  const std::vector<TimedPose>& samples() const { return samples_; }
  const std::string& frame() const { return frame_; }
  const std::string& child_frame() const { return child_frame_; }
  const Pose& target() const { return target_; }

  // Final pose of the hand in the target's frame.
  Pose goal_in_target() const;

  Eigen::MatrixXd positions() const;  // samples x 3, m
  double length() const;              // of the polyline, m

  // `nodes` samples equally spaced along the arc, each with the time and (slerped) orientation of
  // its place on the path. First and last sample are kept.
  [[nodiscard]] Demonstration resampled_by_arc_length(std::size_t nodes) const;

  // The `nodes` samples that Douglas and Peucker's subdivision takes first: always the sample
  // farthest from the lines between those taken. Poses and times as demonstrated. There must be as
  // many samples.
  [[nodiscard]] Demonstration resampled_by_douglas_peucker(std::size_t nodes) const;

  // As many of them, but at least kMinSamples, as leave no sample farther than `tolerance` (m, >=
  // 0) from the lines between those taken.
  [[nodiscard]] Demonstration thinned_by_douglas_peucker(double tolerance) const;

 private:
  template <typename IsEnough>
  Demonstration subdivided(IsEnough&& is_enough) const;

  std::vector<TimedPose> samples_;
  std::string frame_;
  std::string child_frame_;
  Pose target_;
};

// Throws std::invalid_argument with file, line, column, value and bound.
[[nodiscard]] Demonstration load_demonstration(const std::string& path);
[[nodiscard]] Demonstration read_demonstration(std::istream& in, const std::string& name);

}  // namespace elte_planner
