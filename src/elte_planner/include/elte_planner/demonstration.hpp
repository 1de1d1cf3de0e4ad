// SPDX-License-Identifier: BSD-3-Clause
//
// One demonstration of a skill: timed poses of the hand in the planning frame, and the pose of the
// target while they were recorded.
//
// CSV form of load_demonstration() and save_demonstration(); the first three keys are required:
//   # frame: j2s7s300_link_base                 frame of all poses
//   # child_frame: j2s7s300_end_effector        the frame that was guided
//   # target_pose: x y z qx qy qz qw            target in `frame`, m and unit quaternion
//   # any other key: value                      a note
//   time,x,y,z,qx,qy,qz,qw                      s from 0 and strictly rising, m, unit quaternion
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <istream>
#include <map>
#include <ostream>
#include <prf_core/se3.hpp>
#include <string>
#include <vector>

namespace elte_planner {

using prf_core::Pose;

struct TimedPose {
  double time = 0.0;  // s from the start
  Pose pose;
};

// Always valid: the constructor throws std::invalid_argument naming sample, value and bound.
class Demonstration {
 public:
  static constexpr std::size_t kMinSamples = 3;  // a second difference needs as many
  static constexpr std::size_t kMaxSamples = 1000000;
  static constexpr double kMinLength = 1e-6;     // m of path
  static constexpr double kMaxCoordinate = 1e6;  // m
  static constexpr double kMaxTime = 1e6;        // s, eleven days

  using Notes = std::map<std::string, std::string>;

  // Quaternions within prf_core::kUnitQuaternionTolerance of the unit are normalised, others
  // are refused.
  Demonstration(std::vector<TimedPose> samples, std::string frame, std::string child_frame,
                const Pose& target, Notes notes = {});

  const std::vector<TimedPose>& samples() const { return samples_; }
  const std::string& frame() const { return frame_; }
  const std::string& child_frame() const { return child_frame_; }
  const Pose& target() const { return target_; }
  const Notes& notes() const { return notes_; }

  // Final pose of the hand in the target's frame.
  Pose goal_in_target() const;

  Eigen::MatrixXd positions() const;  // samples x 3, m
  double length() const;              // of the polyline, m

  // `nodes` samples equally spaced along the arc, each with the time and orientation
  // interpolated at its place on the path. First and last sample are kept. Throws
  // std::invalid_argument for fewer than kMinSamples nodes.
  [[nodiscard]] Demonstration resampled_by_arc_length(std::size_t nodes) const;

  // Keeps `nodes` samples, chosen by Douglas and Peucker's subdivision: beginning with the first
  // and the last sample, it takes again and again the sample farthest from the polyline through
  // those taken. Poses and times stay as demonstrated. Throws std::invalid_argument unless `nodes`
  // is within [kMinSamples, number of samples].
  [[nodiscard]] Demonstration resampled_by_douglas_peucker(std::size_t nodes) const;

  // The same subdivision, ended when at least kMinSamples are taken and no sample is farther than
  // `tolerance` (m, >= 0) from the polyline. Throws std::invalid_argument for another tolerance.
  [[nodiscard]] Demonstration thinned_by_douglas_peucker(double tolerance) const;

 private:
  template <typename IsEnough>
  Demonstration subdivided(IsEnough&& is_enough) const;
  Demonstration with_samples(std::vector<TimedPose> samples) const;

  std::vector<TimedPose> samples_;
  std::string frame_;
  std::string child_frame_;
  Pose target_;
  Notes notes_;
};

// Files longer than this are refused unread.
constexpr std::size_t kMaxDemonstrationBytes = 200'000'000;

// Throw std::invalid_argument with file, line, column, value and bound.
[[nodiscard]] Demonstration load_demonstration(const std::string& path);
[[nodiscard]] Demonstration read_demonstration(std::istream& in, const std::string& name);

// Times in microseconds, poses to nine decimals. Throws std::invalid_argument when the file cannot
// be written or would not be read back with the same notes.
void save_demonstration(const Demonstration& demonstration, const std::string& path);

}  // namespace elte_planner
