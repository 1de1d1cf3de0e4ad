// SPDX-License-Identifier: BSD-3-Clause
// Renders views of the tag on a plain panel, for studies of detectors.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera_sim/camera_renderer.hpp"
#include "camera_sim/image_noise.hpp"

namespace {

using namespace camera_sim;

constexpr char kUsage[] =
    "usage: render_tag_views NAME=VALUE ... < VIEWS > IMAGES\n"
    "  VIEWS   one line a view: pose x y z (m) qx qy qz qw of the tag in the optical frame (x "
    "right,\n"
    "          y down, z forward; the tag's z out of its face), its velocity vx vy vz (m/s)\n"
    "  IMAGES  one stream of binary PGM images (P5), 8 bit\n"
    "  names, all required: tag_size (m) exposure (s) noise (grey levels) seed clutter (posters) "
    "and\n"
    "  the camera's width height fx fy cx cy k1 k2 p1 p2 k3\n";

constexpr double kPanelDepth = 0.001;   // m: the tag's box is nearly flat
constexpr double kMostInstants = 40.0;  // of an exposure; one for each pixel of blur

const Eigen::Vector3d kCameraInRoom(-1.2, 0.0, 1.3);  // m

struct View {
  Eigen::Isometry3d tag = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};

std::map<std::string, double> read_arguments(int argc, char** argv) {
  std::map<std::string, double> values;
  for (int i = 1; i < argc; ++i) {
    std::istringstream word(argv[i]);
    std::string name;
    double value = 0.0;
    if (!std::getline(word, name, '=') || !(word >> value) || !(word >> std::ws).eof()) {
      throw std::invalid_argument(std::string(argv[i]) + ": must be NAME=NUMBER");
    }
    values[name] = value;
  }
  return values;
}

double take(std::map<std::string, double>& values, const std::string& name) {
  const auto found = values.find(name);
  if (found == values.end()) throw std::invalid_argument(name + " is missing");
  const double value = found->second;
  values.erase(found);
  return value;
}

PinholeCamera take_camera(std::map<std::string, double>& values) {
  PinholeCamera camera;
  camera.width = static_cast<int>(take(values, "width"));
  camera.height = static_cast<int>(take(values, "height"));
  camera.fx = take(values, "fx");
  camera.fy = take(values, "fy");
  camera.cx = take(values, "cx");
  camera.cy = take(values, "cy");
  const std::array<std::string, 5> names{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < names.size(); ++i) camera.distortion[i] = take(values, names[i]);
  return camera;
}

View parse_view(const std::string& line) {
  std::istringstream stream(line);
  std::array<double, 10> n{};
  for (double& number : n) {
    if (!(stream >> number) || !std::isfinite(number)) {
      throw std::invalid_argument("view '" + line + "' must be 10 numbers");
    }
  }
  View view;
  view.tag = Eigen::Translation3d(n[0], n[1], n[2]) *
             Eigen::Quaterniond(n[6], n[3], n[4], n[5]).normalized();
  view.velocity = Eigen::Vector3d(n[7], n[8], n[9]);
  return view;
}

class Studio {
 public:
  explicit Studio(std::map<std::string, double> values)
      : exposure_(take(values, "exposure")),
        target_(panel(take(values, "tag_size"))),
        camera_(take_camera(values)),
        noise_(take(values, "noise"), seed_of(take(values, "seed"))),
        renderer_(camera_, target_, {static_cast<int>(take(values, "clutter")), seed_}) {
    if (!values.empty()) throw std::invalid_argument("unknown " + values.begin()->first);
    if (!(exposure_ >= 0.0 && exposure_ <= 1.0)) {
      throw std::invalid_argument("exposure must be in 0..1 s");
    }
  }

  cv::Mat picture(const View& view, std::uint64_t number) const {
    const double blur =
        camera_.fx * view.velocity.norm() * exposure_ / std::max(0.05, view.tag.translation().z());
    const double instants = std::clamp(std::ceil(blur) + 1.0, 1.0, kMostInstants);
    std::vector<CameraView> exposure;
    for (double i = 0.5; i < instants; ++i) {
      View then = view;
      then.tag.translation() += (i / instants - 0.5) * exposure_ * view.velocity;
      exposure.push_back(in_room(then));
    }
    cv::Mat image = renderer_.render(exposure);
    noise_.add(image, number);
    return image;
  }

 private:
  static TargetBox panel(double tag_size) {
    TargetBox target;
    target.tag_size = tag_size;
    target.inner_depth = kPanelDepth;
    return target;
  }

  std::uint64_t seed_of(double seed) { return seed_ = static_cast<std::uint64_t>(seed); }

  CameraView in_room(const View& view) const {
    CameraView result;
    result.camera = Eigen::Translation3d(kCameraInRoom) *
                    Eigen::AngleAxisd(-M_PI_2, Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(-M_PI_2, Eigen::Vector3d::UnitX());
    result.carrier = result.camera * view.tag * target_.tag_in_platform().inverse();
    return result;
  }

  double exposure_;
  TargetBox target_;
  PinholeCamera camera_;
  std::uint64_t seed_ = 0;
  ImageNoise noise_;
  CameraRenderer renderer_;
};

void render_all(int argc, char** argv) {
  const Studio studio(read_arguments(argc, argv));
  std::string line;
  for (std::uint64_t number = 0; std::getline(std::cin, line); ++number) {
    const cv::Mat image = studio.picture(parse_view(line), number);
    std::cout << "P5\n" << image.cols << " " << image.rows << "\n255\n";
    std::cout.write(image.ptr<char>(), static_cast<std::streamsize>(image.total()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    render_all(argc, argv);
  } catch (const std::invalid_argument& error) {
    std::cerr << "render_tag_views: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
