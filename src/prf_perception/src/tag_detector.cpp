// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/tag_detector.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/apriltag_pose.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <prf_core/require.hpp>
#include <string_view>
#include <tuple>

#include "prf_perception/lens.hpp"

namespace prf_perception {
namespace {

using prf_core::require;
using prf_core::require_between;

struct FamilyFunctions {
  std::string_view name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr std::array<FamilyFunctions, 4> kFamilies{{
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag16h5", tag16h5_create, tag16h5_destroy},
}};

const FamilyFunctions* find_family(const std::string& name) {
  const auto found = std::find_if(kFamilies.begin(), kFamilies.end(),
                                  [&](const auto& family) { return family.name == name; });
  return found == kFamilies.end() ? nullptr : &*found;
}

// libapriltag counts pixels from the first one's outer corner, the camera from its centre.
constexpr double kHalfPixel = 0.5;

Corners corners_of(const apriltag_detection_t& detection) {
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = {detection.p[i][0] - kHalfPixel, detection.p[i][1] - kHalfPixel};
  }
  return corners;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// A convex quadrilateral in or near the image, each corner spanning at least a pixel's area, in the
// order of Corners. Not-a-number fails.
bool is_quadrilateral(const Corners& corners, const CameraIntrinsics& camera) {
  const double farthest = 4.0 * std::max(camera.width, camera.height);
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(corners[i].cwiseAbs().maxCoeff() <= farthest)) return false;
    const Eigen::Vector2d before = corners[i] - corners[(i + 3) % 4];
    const Eigen::Vector2d after = corners[(i + 1) % 4] - corners[i];
    if (!(cross(before, after) <= -1.0)) return false;
  }
  return true;
}

// libapriltag's own estimate, from its axes (y down, z into the tag) turned into ours.
Eigen::Isometry3d initial_pose(apriltag_detection_t& detection, const CameraIntrinsics& camera,
                               double tag_size) {
  apriltag_detection_info_t info{
      &detection, tag_size, camera.fx, camera.fy, camera.cx + kHalfPixel, camera.cy + kHalfPixel};
  apriltag_pose_t pose{};
  estimate_tag_pose(&info, &pose);
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.R->data) *
                    Eigen::Vector3d(1, -1, -1).asDiagonal();
  result.translation() = Eigen::Map<const Eigen::Vector3d>(pose.t->data);
  std::free(pose.R);
  std::free(pose.t);
  return result;
}

}  // namespace

void TagDetectorParams::validate() const {
  require(find_family(family) != nullptr, "tag_family", family,
          "tag36h11, tag36h10, tag25h9 or tag16h5");
  require_between("tag_size", tag_size, 0.005, 5.0, "m");
  require_between("max_hamming", max_hamming, 0, 2, "bits");
  require_between("min_decision_margin", min_decision_margin, 0.0, 255.0, "grey levels");
  require_between("quad_decimate", quad_decimate, 1.0, 4.0);
  require_between("min_white_black_diff", min_white_black_diff, 1, 255, "grey levels");
  error_model.validate();
}

class TagDetector::Impl {
 public:
  explicit Impl(const TagDetectorParams& params)
      : params_(params),
        functions_(*find_family(params.family)),
        family_(functions_.create()),
        detector_(apriltag_detector_create()) {
    apriltag_detector_add_family_bits(detector_, family_, params.max_hamming);
    detector_->nthreads = 1;
    detector_->quad_decimate = static_cast<float>(params.quad_decimate);
    detector_->qtp.min_white_black_diff = params.min_white_black_diff;
  }
  ~Impl() {
    apriltag_detector_destroy(detector_);
    functions_.destroy(family_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::vector<TagDetection> detect(const ImageView& image, const CameraIntrinsics& camera) {
    // libapriltag reads the image only, its type just does not say so.
    image_u8_t view{image.width, image.height, image.stride, const_cast<std::uint8_t*>(image.data)};
    zarray_t* found = apriltag_detector_detect(detector_, &view);
    std::vector<TagDetection> detections;
    for (int i = 0; i < zarray_size(found); ++i) {
      apriltag_detection_t* raw = nullptr;
      zarray_get(found, i, &raw);
      if (auto detection = convert(*raw, camera)) detections.push_back(*detection);
    }
    apriltag_detections_destroy(found);
    std::sort(detections.begin(), detections.end(), [](const auto& a, const auto& b) {
      return std::make_tuple(a.id, -a.decision_margin, a.corners[0].x(), a.corners[0].y()) <
             std::make_tuple(b.id, -b.decision_margin, b.corners[0].x(), b.corners[0].y());
    });
    return detections;
  }

 private:
  std::optional<TagDetection> convert(apriltag_detection_t& raw, const CameraIntrinsics& camera) {
    if (raw.hamming > params_.max_hamming ||
        !(static_cast<double>(raw.decision_margin) >= params_.min_decision_margin)) {
      return std::nullopt;
    }
    const Corners corners = corners_of(raw);
    const Corners ideal = ideal_corners(corners, camera);
    if (!is_quadrilateral(ideal, camera)) return std::nullopt;
    for (std::size_t i = 0; i < 4; ++i) {
      raw.p[i][0] = ideal[i].x() + kHalfPixel;
      raw.p[i][1] = ideal[i].y() + kHalfPixel;
    }
    const auto pose =
        estimate_square_pose(ideal, camera, params_.tag_size,
                             initial_pose(raw, camera, params_.tag_size), params_.error_model);
    if (!pose) return std::nullopt;
    return TagDetection{raw.id, raw.hamming, static_cast<double>(raw.decision_margin), corners,
                        *pose};
  }

  TagDetectorParams params_;
  FamilyFunctions functions_;
  apriltag_family_t* family_;
  apriltag_detector_t* detector_;
};

TagDetector::TagDetector(const TagDetectorParams& params) {
  params.validate();
  impl_ = std::make_unique<Impl>(params);
}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<TagDetection> TagDetector::detect(const ImageView& image,
                                              const CameraIntrinsics& camera) {
  camera.validate();
  require(image.data != nullptr, "image data", "null", "given");
  require(image.width == camera.width, "image width", image.width,
          std::to_string(camera.width) + " px, the camera's");
  require(image.height == camera.height, "image height", image.height,
          std::to_string(camera.height) + " px, the camera's");
  require(image.stride >= image.width, "image stride", image.stride, ">= the width");
  return impl_->detect(image, camera);
}

}  // namespace prf_perception
