// SPDX-License-Identifier: BSD-3-Clause
// A moving pose, the forecast of the target and the planned skill, as the decision sees them.
//
// Everything is expressed in the planning frame (base of the arm), metres, radians and seconds.
// Between two instants with known poses the position follows the cubic Hermite polynomial of
// their velocities and the orientation the shortest great arc (slerp).
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "prf_decision/stamp.hpp"

namespace prf_decision {

struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct MovingPose {
  Pose pose;
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();   // m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // rad/s, in the planning frame
};

enum class TargetStatus { kNoTarget, kTracking, kCoasting, kLost };

struct Prediction {
  Duration horizon{0};  // from the forecast's stamp
  MovingPose target;
};

struct Forecast {
  Stamp stamp{0};
  TargetStatus status = TargetStatus::kNoTarget;
  Duration since_measurement{0};        // at the stamp
  std::vector<Prediction> predictions;  // horizons strictly rising from 0; empty without a target

  // std::invalid_argument names the member, its value and the bound.
  void validate() const;
};

struct Trajectory {
  std::vector<Pose> poses;
  std::vector<Duration> times;  // nominal time of each pose, strictly rising from 0
  Pose goal_in_target;          // last pose of the hand in the target's frame

  void validate() const;
};

// Rotation vector (axis times angle in [0, pi]) that takes `from` to `to`, in the planning frame.
[[nodiscard]] Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from,
                                               const Eigen::Quaterniond& to);

// Target at `stamp`; beyond the last horizon it stands at the last prediction.
// The forecast must have predictions.
[[nodiscard]] MovingPose target_at(const Forecast& forecast, Stamp stamp);

// Pose and velocity of a frame that is rigidly attached to a moving one.
[[nodiscard]] MovingPose attached(const MovingPose& carrier, const Pose& frame_in_carrier);

}  // namespace prf_decision
