// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "camera_sim/camera_renderer.hpp"
#include "camera_sim/target_box.hpp"

namespace scene_drawing {

/// Where everything stands at one instant. Poses are in world.
struct SceneState {
  Eigen::Isometry3d platform = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d carrier =
      Eigen::Isometry3d::Identity();  ///< what carries the box: platform or cart
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();  ///< root link of the robot
  std::map<std::string, double> joints;  ///< rad, by name; other names are ignored
};

/// Optical frame of a camera at `eye` that looks at `target`, upright. `target` must
/// not be straight above or below `eye`, which is not checked: the result would be no rotation.
[[nodiscard]] Eigen::Isometry3d look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// Pictures of the whole scene for reports: the robot's visual shapes (boxes, cylinders, spheres),
/// treadmill or cart, box and tag, by z-buffer with flat shading and the shadow on the ground.
class SceneRenderer {
 public:
  /// Throws std::invalid_argument for a robot description that cannot be read or has other shapes.
  SceneRenderer(const std::string& urdf_xml, const camera_sim::TargetBox& target);
  ~SceneRenderer();
  SceneRenderer(SceneRenderer&&) noexcept;
  SceneRenderer& operator=(SceneRenderer&&) noexcept;

  /// 8 bit BGR image. Throws std::invalid_argument if a moving joint of the robot has no value.
  [[nodiscard]] cv::Mat render(const SceneState& state, const camera_sim::PinholeCamera& camera,
                               const Eigen::Isometry3d& camera_in_world) const;

 private:
  class Robot;
  camera_sim::TargetBox target_;
  std::unique_ptr<Robot> robot_;
};

}  // namespace scene_drawing
