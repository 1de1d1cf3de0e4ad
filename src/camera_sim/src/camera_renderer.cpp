// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/camera_renderer.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <prf_core/require.hpp>
#include <stdexcept>

#include "camera_canvas.hpp"
#include "scene_facets.hpp"

namespace camera_sim {

// Painter's algorithm: the separators of the bodies give the order for any place of the camera.
class CameraRenderer::Scene {
 public:
  Scene(const PinholeCamera& camera, const TargetBox& target, const Clutter& clutter)
      : lens_(camera),
        room_(room_facets(target)),
        posters_(room_posters(target, clutter)),
        platform_(platform_body()),
        bodies_(target_bodies(target)),
        tag_(tag_print(target)) {}

  void paint(const CameraView& view, cv::Mat& image) const {
    CameraCanvas canvas(lens_, image);
    const Eigen::Isometry3d world_to_camera = view.camera.inverse();
    for (const Facet& facet : room_) canvas.paint(facet, world_to_camera);
    for (const Print& poster : posters_) canvas.paint(poster, world_to_camera);

    const Eigen::Isometry3d platform_to_camera = world_to_camera * view.platform;
    const bool is_above = platform_to_camera.inverse().translation().z() >= 0.0;
    if (is_above) paint_body(platform_, platform_to_camera, canvas);
    paint_target(world_to_camera * view.carrier, canvas);
    if (!is_above) paint_body(platform_, platform_to_camera, canvas);
  }

 private:
  void paint_target(const Eigen::Isometry3d& to_camera, CameraCanvas& canvas) const {
    const Eigen::Vector3d eye = to_camera.inverse().translation();
    const auto is_behind = [&](const Body& body) {
      return body.separator.signedDistance(eye) >= 0;
    };
    for (const Body& body : bodies_) {
      if (!is_behind(body)) continue;
      paint_body(body, to_camera, canvas);
      if (body.carries_tag) canvas.paint(tag_, to_camera);
    }
    for (auto body = bodies_.rbegin(); body != bodies_.rend(); ++body) {
      if (!is_behind(*body)) paint_body(*body, to_camera, canvas);
    }
  }

  static void paint_body(const Body& body, const Eigen::Isometry3d& to_camera,
                         CameraCanvas& canvas) {
    for (const Facet& facet : body.facets) canvas.paint(facet, to_camera);
  }

  CameraLens lens_;
  std::vector<Facet> room_;
  std::vector<Print> posters_;
  Body platform_;
  std::vector<Body> bodies_;
  Print tag_;
};

CameraRenderer::CameraRenderer(const PinholeCamera& camera, const TargetBox& target,
                               const Clutter& clutter)
    : camera_(camera) {
  camera.validate();
  target.validate();
  prf_core::require_between("clutter", clutter.posters, 0, Clutter::kMost);
  scene_ = std::make_unique<Scene>(camera, target, clutter);
}
CameraRenderer::~CameraRenderer() = default;
CameraRenderer::CameraRenderer(CameraRenderer&&) noexcept = default;
CameraRenderer& CameraRenderer::operator=(CameraRenderer&&) noexcept = default;

cv::Mat CameraRenderer::render(const CameraView& view) const {
  cv::Mat image(camera_.height, camera_.width, CV_8UC1, cv::Scalar(0));
  scene_->paint(view, image);
  return image;
}

cv::Mat CameraRenderer::render(const std::vector<CameraView>& exposure) const {
  if (exposure.empty()) throw std::invalid_argument("exposure has 0 views, must be at least 1");
  if (exposure.size() == 1) return render(exposure.front());
  cv::Mat sum(camera_.height, camera_.width, CV_32FC1, cv::Scalar(0));
  for (const CameraView& view : exposure) cv::add(sum, render(view), sum, cv::noArray(), CV_32F);
  cv::Mat mean;
  sum.convertTo(mean, CV_8U, 1.0 / static_cast<double>(exposure.size()));
  return mean;
}

}  // namespace camera_sim
