// SPDX-License-Identifier: BSD-3-Clause
// Finds tags in a stream of PGM images: the detector without ROS, for studies.
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "prf_perception/tag_detector.hpp"

namespace {

using namespace prf_perception;

constexpr char kUsage[] =
    "usage: detect_tags NAME=VALUE ... < IMAGES > DETECTIONS\n"
    "  IMAGES      one stream of binary PGM images (P5), 8 bit\n"
    "  DETECTIONS  CSV: image, id, pose x y z (m) qx qy qz qw of the tag in the optical frame, "
    "and\n"
    "              its covariance, 36 numbers row by row\n"
    "  names, all required: the detector's tag_family tag_size max_hamming min_decision_margin\n"
    "  quad_decimate min_white_black_diff corner_sigma position_floor orientation_floor, and the\n"
    "  camera's width height fx fy cx cy k1 k2 p1 p2 k3\n";

class Arguments {
 public:
  Arguments(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      const std::size_t equals = word.find('=');
      if (equals == std::string::npos) throw std::invalid_argument("'" + word + "' has no '='");
      values_[word.substr(0, equals)] = word.substr(equals + 1);
    }
  }

  std::string text(const std::string& name) {
    const auto found = values_.find(name);
    if (found == values_.end()) throw std::invalid_argument(name + " is missing");
    const std::string value = found->second;
    values_.erase(found);
    return value;
  }
  double number(const std::string& name) {
    const std::string value = text(name);
    try {
      std::size_t used = 0;
      const double result = std::stod(value, &used);
      if (used == value.size()) return result;
    } catch (const std::exception&) {
    }
    throw std::invalid_argument(name + " = " + value + ", must be a number");
  }
  int integer(const std::string& name) { return static_cast<int>(number(name)); }
  void refuse_unknown() const {
    if (!values_.empty()) throw std::invalid_argument("unknown " + values_.begin()->first);
  }

 private:
  std::map<std::string, std::string> values_;
};

TagDetectorParams read_detector(Arguments& arguments) {
  TagDetectorParams params;
  params.family = arguments.text("tag_family");
  params.tag_size = arguments.number("tag_size");
  params.max_hamming = arguments.integer("max_hamming");
  params.min_decision_margin = arguments.number("min_decision_margin");
  params.quad_decimate = arguments.number("quad_decimate");
  params.min_white_black_diff = arguments.integer("min_white_black_diff");
  params.error_model.corner_sigma = arguments.number("corner_sigma");
  params.error_model.position_floor = arguments.number("position_floor");
  params.error_model.orientation_floor = arguments.number("orientation_floor");
  return params;
}

CameraIntrinsics read_camera(Arguments& arguments) {
  CameraIntrinsics camera;
  camera.width = arguments.integer("width");
  camera.height = arguments.integer("height");
  camera.fx = arguments.number("fx");
  camera.fy = arguments.number("fy");
  camera.cx = arguments.number("cx");
  camera.cy = arguments.number("cy");
  const std::array<std::string, 5> names{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    camera.distortion[i] = arguments.number(names[i]);
  }
  validate(camera);
  return camera;
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

void detect_all(Arguments arguments) {
  TagDetector detector(read_detector(arguments));
  const CameraIntrinsics camera = read_camera(arguments);
  arguments.refuse_unknown();
  std::cout.precision(12);
  std::vector<std::uint8_t> pixels;
  for (int image = 0; read_image(std::cin, camera, pixels); ++image) {
    const ImageView view{pixels.data(), camera.width, camera.height, camera.width};
    for (const TagDetection& detection : detector.detect(view, camera)) print(image, detection);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    detect_all(Arguments(argc, argv));
  } catch (const std::invalid_argument& error) {
    std::cerr << "detect_tags: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
