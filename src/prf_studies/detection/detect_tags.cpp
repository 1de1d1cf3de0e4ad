// SPDX-License-Identifier: BSD-3-Clause
// Finds tags in a stream of PGM images: the detector without ROS, for studies.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <iostream>
#include <prf_perception/tag_detector.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace prf_perception;

struct Params {
  TagDetectorParams detector;
  CameraIntrinsics camera;
};

// Options bear the names of config/tag_detector.yaml and of the camera's numbers; all are required.
void add_options(CLI::App& app, Params& params) {
  const auto add = [&](const std::string& name, auto& value, const std::string& meaning) {
    app.add_option("--" + name, value, meaning)->required();
  };
  TagDetectorParams& detector = params.detector;
  add("tag_family", detector.family, "as tag36h11");
  add("tag_size", detector.tag_size, "m");
  add("max_hamming", detector.max_hamming, "bits");
  add("min_decision_margin", detector.min_decision_margin, "grey levels");
  add("quad_decimate", detector.quad_decimate, "factor");
  add("min_white_black_diff", detector.min_white_black_diff, "grey levels");
  add("corner_sigma", detector.error_model.corner_sigma, "px");
  add("position_floor", detector.error_model.position_floor, "m");
  add("orientation_floor", detector.error_model.orientation_floor, "rad");
  CameraIntrinsics& camera = params.camera;
  add("width", camera.width, "px");
  add("height", camera.height, "px");
  add("fx", camera.fx, "px");
  add("fy", camera.fy, "px");
  add("cx", camera.cx, "px");
  add("cy", camera.cy, "px");
  const std::array<std::string, 5> coefficients{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    add(coefficients[i], camera.distortion[i], "distortion");
  }
}

// The pixels of the next image; false at the end of the stream.
bool read_image(std::istream& stream, const CameraIntrinsics& camera,
                std::vector<std::uint8_t>& pixels) {
  std::string magic;
  if (!(stream >> magic)) return false;
  int width = 0, height = 0, levels = 0;
  stream >> width >> height >> levels;
  if (magic != "P5" || width != camera.width || height != camera.height || levels != 255) {
    throw std::invalid_argument("the images must be PGM (P5), 8 bit, of the camera's size");
  }
  stream.get();
  pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  stream.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(pixels.size()));
  if (!stream) throw std::invalid_argument("the last image is cut off");
  return true;
}

void print(int image, const TagDetection& detection) {
  const Eigen::Isometry3d& pose = detection.pose.marker_in_camera;
  const Eigen::Quaterniond q(pose.linear());
  std::cout << image << "," << detection.id;
  for (const double p : {pose.translation().x(), pose.translation().y(), pose.translation().z(),
                         q.x(), q.y(), q.z(), q.w()}) {
    std::cout << "," << p;
  }
  for (int i = 0; i < 36; ++i) std::cout << "," << detection.pose.covariance(i / 6, i % 6);
  std::cout << "\n";
}

void detect_all(const Params& params) {
  TagDetector detector(params.detector);
  const CameraIntrinsics& camera = params.camera;
  camera.validate();
  std::cout.precision(12);
  std::vector<std::uint8_t> pixels;
  for (int image = 0; read_image(std::cin, camera, pixels); ++image) {
    const ImageView view{pixels.data(), camera.width, camera.height, camera.width};
    for (const TagDetection& detection : detector.detect(view, camera)) print(image, detection);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Finds tags in a stream of binary PGM images (P5, 8 bit) on standard input. Prints CSV: "
      "image, "
      "id, pose x y z (m) qx qy qz qw of the tag in the optical frame, and its covariance, 36 "
      "numbers row by row.");
  Params params;
  add_options(app, params);
  try {
    app.parse(argc, argv);
    detect_all(params);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& error) {
    std::cerr << "detect_tags: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
