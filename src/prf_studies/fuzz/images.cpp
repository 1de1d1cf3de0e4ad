// SPDX-License-Identifier: BSD-3-Clause
// What the tag detector takes from an image and its camera_info, and what it finds in it.
#include "../../prf_perception/node/conversions.hpp"
#include "fuzz_target.hpp"

namespace {

using namespace prf_perception;

TagDetector& detector() {
  static TagDetector one([] {
    TagDetectorParams params;
    params.family = "tag36h11";
    params.tag_size = 0.1;
    params.max_hamming = 1;
    params.quad_decimate = 1.0;
    params.min_white_black_diff = 5;
    params.error_model = {0.06, 0.0003, 0.002};
    return params;
  }());
  return one;
}

void check(const TagDetection& detection) {
  const SquarePose& pose = detection.pose;
  for (const auto& corner : detection.corners) {
    fuzz::expect(corner.allFinite(), "a corner is finite");
  }
  fuzz::expect(pose.marker_in_camera.matrix().allFinite(), "the pose of a tag is finite");
  fuzz::expect(pose.covariance.allFinite() && pose.covariance.diagonal().minCoeff() >= 0.0,
               "its covariance is one");
  fuzz::expect(pose.ambiguity() >= 0.0 && pose.ambiguity() <= 1.0, "its ambiguity is a share");
}

}  // namespace

// Messages of an even kind are a camera_info, of an odd one an image; each image is looked at with
// the camera_info before it.
FUZZ_TARGET(detector_images) {
  sensor_msgs::CameraInfo info;
  fuzz::for_each_message(bytes, [&](int kind, fuzz::Bytes part) {
    if (kind % 2 == 0) {
      sensor_msgs::CameraInfo read;
      if (fuzz::read(part, read)) info = read;
      return;
    }
    const sensor_msgs::ImagePtr image(new sensor_msgs::Image);
    if (!fuzz::read(part, *image)) return;
    fuzz::accepts([&] {
      const auto grey = to_grey(image);
      fuzz::expect(grey->image.cols == static_cast<int>(image->width) &&
                       grey->image.rows == static_cast<int>(image->height),
                   "a grey image is as large as the image");
      const CameraIntrinsics camera = to_intrinsics(info, *image);
      camera.validate();
      const auto found = detector().detect({grey->image.data, grey->image.cols, grey->image.rows,
                                            static_cast<int>(grey->image.step)},
                                           camera);
      for (const TagDetection& detection : found) check(detection);
      for (const auto& detection : to_message(image->header, "tag36h11", found).detections) {
        (void)to_transform(image->header, detection);
      }
    });
  });
}
