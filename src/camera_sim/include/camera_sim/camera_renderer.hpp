// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "camera_sim/pinhole_camera.hpp"
#include "camera_sim/target_box.hpp"

namespace camera_sim {

/// Where the camera's optical frame, the platform and what carries the box (the platform or a cart)
/// are in world at one instant.
struct CameraView {
  Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d platform = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d carrier = Eigen::Isometry3d::Identity();
};

/// Posters with square patterns on the walls of the room, drawn from the seed.
struct Clutter {
  static constexpr int kMost = 200;
  int posters = 0;  ///< 0..kMost
  std::uint64_t seed = 0;
};

/// What the hand camera sees of the platform, the box on its post or cart with tag 0 of the family
/// tag36h11, and the room around them: mono8, anti-aliased by area, without noise, robot or hand.
class CameraRenderer {
 public:
  /// Throws std::invalid_argument for an invalid camera, box or number of posters.
  CameraRenderer(const PinholeCamera& camera, const TargetBox& target, const Clutter& clutter = {});
  ~CameraRenderer();
  CameraRenderer(CameraRenderer&&) noexcept;
  CameraRenderer& operator=(CameraRenderer&&) noexcept;

  [[nodiscard]] cv::Mat render(const CameraView& view) const;
  /// Mean of the renderings of instants spread over an exposure: motion blur.
  /// Throws std::invalid_argument if `exposure` is empty.
  [[nodiscard]] cv::Mat render(const std::vector<CameraView>& exposure) const;

 private:
  class Scene;
  PinholeCamera camera_;
  std::unique_ptr<Scene> scene_;
};

}  // namespace camera_sim
