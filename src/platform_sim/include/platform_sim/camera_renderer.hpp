// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "platform_sim/target_box.hpp"

namespace platform_sim {

/// Pinhole without distortion. A point (x, y, z) of the optical frame (x right, y down, z forward)
/// is seen at pixel (fx x/z + cx, fy y/z + cy); the centre of the first pixel is (0, 0).
struct PinholeCamera {
  int width = 640;
  int height = 480;
  double fx = 615.0;
  double fy = 615.0;
  double cx = 320.0;
  double cy = 240.0;

  /// Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

/// Where the camera's optical frame and the platform are in world at one instant.
struct CameraView {
  Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d platform = Eigen::Isometry3d::Identity();
};

/// What the hand camera sees of the deck, the box on its post with tag 0 of the family tag36h11,
/// and the room around them: mono8, anti-aliased by area, without noise. The robot is not drawn.
class CameraRenderer {
 public:
  /// Throws std::invalid_argument for an invalid camera or box.
  CameraRenderer(const PinholeCamera& camera, const TargetBox& target);
  ~CameraRenderer();
  CameraRenderer(CameraRenderer&&) noexcept;
  CameraRenderer& operator=(CameraRenderer&&) noexcept;

  [[nodiscard]] cv::Mat render(const CameraView& view) const;
  /// Mean of the renderings of instants spread over an exposure: motion blur.
  /// Throws std::invalid_argument if there is none.
  [[nodiscard]] cv::Mat render(const std::vector<CameraView>& exposure) const;

 private:
  class Scene;
  PinholeCamera camera_;
  std::unique_ptr<Scene> scene_;
};

}  // namespace platform_sim
