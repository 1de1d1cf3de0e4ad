// SPDX-License-Identifier: BSD-3-Clause
#include "camera_canvas.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace camera_sim {
namespace {

constexpr double kNearPlane = 0.01;    // m
constexpr double kPieceOfEdge = 20.0;  // px, as long as a bent edge counts as straight
constexpr double kViewMargin = 0.02;   // of the view, in normalised coordinates
constexpr int kBorderSpacing = 8;      // px
constexpr double kHalfPixel = 0.5;     // from the first pixel's corner to its centre

// Sutherland and Hodgman (1974): the part where normal.point >= offset.
std::vector<Eigen::Vector3d> clipped(const std::vector<Eigen::Vector3d>& corners,
                                     const Eigen::Vector3d& normal, double offset) {
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& a = corners[i];
    const Eigen::Vector3d& b = corners[(i + 1) % corners.size()];
    const double a_inside = normal.dot(a) - offset, b_inside = normal.dot(b) - offset;
    if (a_inside >= 0.0) kept.push_back(a);
    if ((a_inside >= 0.0) != (b_inside >= 0.0)) {
      kept.push_back(a + a_inside / (a_inside - b_inside) * (b - a));
    }
  }
  return kept;
}

// Inward normals of the pyramid over the smallest rectangle of normalised coordinates in view.
std::vector<Eigen::Vector3d> planes_around_view(const PinholeCamera& camera) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  const auto include = [&](double x, double y) {
    const Eigen::Vector2d normalised = camera.to_normalised({x, y});
    low = low.cwiseMin(normalised);
    high = high.cwiseMax(normalised);
  };
  const double right = camera.width - kHalfPixel, bottom = camera.height - kHalfPixel;
  for (double x = -kHalfPixel; x <= right; x += kBorderSpacing) {
    include(x, -kHalfPixel);
    include(x, bottom);
  }
  for (double y = -kHalfPixel; y <= bottom; y += kBorderSpacing) {
    include(-kHalfPixel, y);
    include(right, y);
  }
  include(right, bottom);
  low.array() -= kViewMargin;
  high.array() += kViewMargin;
  return {{1.0, 0.0, -low.x()}, {-1.0, 0.0, high.x()}, {0.0, 1.0, -low.y()}, {0.0, -1.0, high.y()}};
}

unsigned char blend(unsigned char below, unsigned char above, float coverage) {
  const float value = static_cast<float>(below) +
                      coverage * (static_cast<float>(above) - static_cast<float>(below));
  // Half up in single precision; lround would change single grey levels of all recorded images.
  return static_cast<unsigned char>(value + 0.5F);  // NOLINT(bugprone-incorrect-roundings)
}

std::vector<Eigen::Vector3d> seen_from(const Eigen::Isometry3d& to_camera,
                                       const std::array<Eigen::Vector3d, 4>& corners) {
  std::vector<Eigen::Vector3d> seen;
  for (const Eigen::Vector3d& corner : corners) seen.push_back(to_camera * corner);
  return seen;
}

bool shows_its_back(const std::vector<Eigen::Vector3d>& corners) {
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]);
  return normal.dot(corners[0]) >= 0.0;
}

}  // namespace

CameraLens::CameraLens(const PinholeCamera& camera)
    : camera_(camera), view_planes_(planes_around_view(camera)) {
  if (!camera.distorts()) return;
  const Eigen::Vector2d per_pixel(1.0 / camera.fx, 1.0 / camera.fy);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d normalised = camera.to_normalised(Eigen::Vector2d(x, y));
      Eigen::Matrix<double, 2, 3> ray;
      ray << normalised, camera.distortion_jacobian(normalised).inverse() * per_pixel.asDiagonal();
      rays_.push_back(ray.cast<float>());
    }
  }
}

Polygon2d CameraLens::outline(std::vector<Eigen::Vector3d> corners) const {
  corners = clipped(corners, Eigen::Vector3d::UnitZ(), kNearPlane);
  for (const Eigen::Vector3d& plane : view_planes_) {
    if (corners.empty()) return {};
    corners = clipped(corners, plane, 0.0);
  }
  const auto pixel = [&](const Eigen::Vector2d& normalised) -> Eigen::Vector2d {
    return camera_.to_pixel(normalised).array() + kHalfPixel;
  };
  Polygon2d result;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d a = corners[i].hnormalized();
    result.push_back(pixel(a));
    if (rays_.empty()) continue;
    const Eigen::Vector2d b = corners[(i + 1) % corners.size()].hnormalized();
    const double pieces = std::ceil((b - a).norm() * camera_.fx / kPieceOfEdge);
    for (double k = 1.0; k < pieces; ++k) result.push_back(pixel(a + k / pieces * (b - a)));
  }
  return result;
}

CameraCanvas::CameraCanvas(const CameraLens& lens, cv::Mat& mono8)
    : lens_(lens), image_(mono8), raster_(mono8.cols, mono8.rows) {}

void CameraCanvas::paint(const Facet& facet, const Eigen::Isometry3d& to_camera) {
  const auto corners = seen_from(to_camera, facet.corners);
  if (shows_its_back(corners)) return;
  raster_.fill(lens_.outline(corners), [&](int y, int begin, int end, const float* coverage) {
    unsigned char* row = image_.ptr(y);
    if (!coverage) {
      std::fill(row + begin, row + end, facet.grey);
      return;
    }
    for (int x = begin; x < end; ++x) row[x] = blend(row[x], facet.grey, coverage[x - begin]);
  });
}

void CameraCanvas::paint(const Print& print, const Eigen::Isometry3d& to_camera) {
  const auto corners = seen_from(to_camera, print.corners());
  if (shows_its_back(corners)) return;
  // Cell (u, v) of the print lies at origin + u right + v down; a homogeneous matrix of the optical
  // frame, whose inverse takes lines of sight to cells.
  Eigen::Matrix3d from_cells;
  from_cells.col(0) = (corners[2] - corners[3]) / print.texture.columns();
  from_cells.col(1) = (corners[0] - corners[3]) / print.texture.rows();
  from_cells.col(2) = corners[3];
  const Eigen::Matrix3d to_cells = from_cells.inverse();

  raster_.fill(lens_.outline(corners), [&](int y, int begin, int end, const float* coverage) {
    unsigned char* row = image_.ptr(y);
    for (int x = begin; x < end; ++x) {
      // The map is projective; within a pixel its derivative at the centre stands for it.
      const CameraLens::Ray ray = lens_.ray(x, y);
      const Eigen::Vector3d point = to_cells * ray.normalised.homogeneous();
      const Eigen::Vector2d cell = point.hnormalized();
      const Eigen::Matrix2d derivative =
          (to_cells.topLeftCorner<2, 2>() - cell * to_cells.bottomLeftCorner<1, 2>()) / point.z() *
          ray.derivative;
      const unsigned char grey = print.texture.mean_over_pixel(cell, derivative);
      row[x] = coverage ? blend(row[x], grey, coverage[x - begin]) : grey;
    }
  });
}

}  // namespace camera_sim
