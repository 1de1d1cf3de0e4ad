// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/camera_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>

#include "convex_raster.hpp"
#include "scene_facets.hpp"
#include "tag_texture.hpp"

namespace platform_sim {
namespace {

constexpr double kNearPlane = 0.01;  // m

void require(bool holds, const std::string& name, double value, const std::string& bound) {
  if (!holds) {
    throw std::invalid_argument(name + " is " + std::to_string(value) + ", must be " + bound);
  }
}

// Sutherland and Hodgman (1974), for the one plane z = kNearPlane.
std::vector<Eigen::Vector3d> clip_near(const std::array<Eigen::Vector3d, 4>& corners) {
  std::vector<Eigen::Vector3d> clipped;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& a = corners[i];
    const Eigen::Vector3d& b = corners[(i + 1) % corners.size()];
    if (a.z() >= kNearPlane) clipped.push_back(a);
    if ((a.z() >= kNearPlane) != (b.z() >= kNearPlane)) {
      clipped.push_back(a + (kNearPlane - a.z()) / (b.z() - a.z()) * (b - a));
    }
  }
  return clipped;
}

unsigned char blend(unsigned char below, unsigned char above, float coverage) {
  const float value = static_cast<float>(below) +
                      coverage * (static_cast<float>(above) - static_cast<float>(below));
  return static_cast<unsigned char>(value + 0.5F);
}

}  // namespace

void PinholeCamera::validate() const {
  require(width > 0 && width <= 4096, "width", width, "in 1..4096 px");
  require(height > 0 && height <= 4096, "height", height, "in 1..4096 px");
  require(fx > 0.0 && std::isfinite(fx), "fx", fx, "finite and > 0 px");
  require(fy > 0.0 && std::isfinite(fy), "fy", fy, "finite and > 0 px");
  require(std::isfinite(cx), "cx", cx, "finite");
  require(std::isfinite(cy), "cy", cy, "finite");
}

// Painter's algorithm: the separators of the bodies give the order for any place of the camera.
class CameraRenderer::Scene {
 public:
  Scene(const PinholeCamera& camera, const TargetBox& target)
      : width_(camera.width),
        height_(camera.height),
        room_(room_facets()),
        bodies_(platform_bodies(target)),
        tag_in_platform_(target.tag_in_platform()),
        tag_module_(target.tag_size / tag_.black_side()) {
    // Pixel coordinates of the scan conversion start at the first pixel's corner, not its centre.
    intrinsics_ << camera.fx, 0.0, camera.cx + 0.5, 0.0, camera.fy, camera.cy + 0.5, 0.0, 0.0, 1.0;
  }

  void paint(const CameraView& view, cv::Mat& image) const {
    const Eigen::Isometry3d world_to_camera = view.camera.inverse();
    for (const Facet& facet : room_) paint_facet(facet, world_to_camera, image);

    const Eigen::Isometry3d to_camera = world_to_camera * view.platform;
    const Eigen::Vector3d eye = to_camera.inverse().translation();
    const auto is_behind = [&](const Body& body) {
      return body.separator.signedDistance(eye) >= 0;
    };
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!is_behind(bodies_[i])) continue;
      paint_body(bodies_[i], to_camera, image);
      if (i == kBackWall) paint_tag(to_camera, image);
    }
    for (std::size_t i = bodies_.size(); i-- > 0;) {
      if (!is_behind(bodies_[i])) paint_body(bodies_[i], to_camera, image);
    }
  }

 private:
  void paint_body(const Body& body, const Eigen::Isometry3d& to_camera, cv::Mat& image) const {
    for (const Facet& facet : body.facets) paint_facet(facet, to_camera, image);
  }

  // The facet's outline in the image, empty if its back is seen or it is behind the camera.
  Polygon2d project(const Facet& facet, const Eigen::Isometry3d& to_camera) const {
    Facet seen;
    for (std::size_t i = 0; i < 4; ++i) seen.corners[i] = to_camera * facet.corners[i];
    if (seen.normal().dot(seen.corners[0]) >= 0.0) return {};
    Polygon2d outline;
    for (const Eigen::Vector3d& point : clip_near(seen.corners)) {
      outline.push_back((intrinsics_ * point).hnormalized());
    }
    return outline;
  }

  void paint_facet(const Facet& facet, const Eigen::Isometry3d& to_camera, cv::Mat& image) const {
    rasterize_convex(project(facet, to_camera), width_, height_,
                     [&](int y, int begin, int end, const float* coverage) {
                       unsigned char* row = image.ptr(y);
                       if (!coverage) {
                         std::fill(row + begin, row + end, facet.grey);
                         return;
                       }
                       for (int x = begin; x < end; ++x) {
                         row[x] = blend(row[x], facet.grey, coverage[x - begin]);
                       }
                     });
  }

  void paint_tag(const Eigen::Isometry3d& platform_to_camera, cv::Mat& image) const {
    const Eigen::Isometry3d tag_to_camera = platform_to_camera * tag_in_platform_;
    const double half = 0.5 * tag_module_ * tag_.side();
    const Facet face{{Eigen::Vector3d(-half, -half, 0.0), Eigen::Vector3d(half, -half, 0.0),
                      Eigen::Vector3d(half, half, 0.0), Eigen::Vector3d(-half, half, 0.0)},
                     0};
    // Point of the tag plane at module (u, v): x = u m - half, y = half - v m.
    Eigen::Matrix3d from_modules;
    from_modules.col(0) = tag_to_camera.linear().col(0) * tag_module_;
    from_modules.col(1) = -tag_to_camera.linear().col(1) * tag_module_;
    from_modules.col(2) = tag_to_camera * Eigen::Vector3d(-half, half, 0.0);
    const Eigen::Matrix3d to_modules = (intrinsics_ * from_modules).inverse();

    rasterize_convex(project(face, tag_to_camera), width_, height_,
                     [&](int y, int begin, int end, const float* coverage) {
                       unsigned char* row = image.ptr(y);
                       for (int x = begin; x < end; ++x) {
                         const unsigned char grey = tag_.mean_over_pixel(to_modules, x, y);
                         row[x] = coverage ? blend(row[x], grey, coverage[x - begin]) : grey;
                       }
                     });
  }

  int width_, height_;
  Eigen::Matrix3d intrinsics_;
  std::vector<Facet> room_;
  std::vector<Body> bodies_;
  TagTexture tag_;
  Eigen::Isometry3d tag_in_platform_;
  double tag_module_;
};

CameraRenderer::CameraRenderer(const PinholeCamera& camera, const TargetBox& target)
    : camera_(camera) {
  camera.validate();
  target.validate();
  scene_ = std::make_unique<Scene>(camera, target);
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

}  // namespace platform_sim
