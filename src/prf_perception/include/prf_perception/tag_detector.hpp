// SPDX-License-Identifier: BSD-3-Clause
// AprilTags in a grey image: identity, corners and pose with covariance, found by libapriltag
// (E. Olson, ICRA 2011) and refined by square_pose.hpp.
//
// Tag axes: x right, y up, z out of the printed face, seen by a viewer in front of it. The result
// depends on nothing but the arguments: one thread, detections ordered by id, then by margin.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "prf_perception/square_pose.hpp"

namespace prf_perception {

struct TagDetectorParams {
  std::string family;              // tag36h11, tag36h10, tag25h9 or tag16h5
  double tag_size = 0.0;           // side of the black border's outer edge, m, > 0
  int max_hamming = 0;             // most corrected bits accepted, 0 .. 2
  double min_decision_margin = 0;  // least contrast accepted, grey levels, >= 0
  double quad_decimate = 0.0;      // squares are searched in the image reduced by this, 1 .. 4
  int min_white_black_diff = 0;    // least contrast between face and border, grey levels, 1 .. 255
  CornerErrorModel error_model;

  void validate() const;  // throws std::invalid_argument with name, value and bound
};

struct TagDetection {
  int id = 0;
  int hamming = 0;
  double decision_margin = 0.0;  // grey levels
  Corners corners{};             // px in the image, (0, 0) is the centre of the first pixel
  SquarePose pose;
};

class TagDetector {
 public:
  // Throws like TagDetectorParams::validate().
  explicit TagDetector(const TagDetectorParams& params);
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  // The image must not be rectified: distortion is taken from `camera`. A tag whose pose cannot be
  // estimated is left out.
  // Throws std::invalid_argument when the image's size is not the camera's or below 32 px.
  [[nodiscard]] std::vector<TagDetection> detect(const ImageView& image,
                                                 const CameraIntrinsics& camera);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prf_perception
