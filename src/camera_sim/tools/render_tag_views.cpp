// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera_sim/camera_renderer.hpp"
#include "camera_sim/image_noise.hpp"

namespace {

using namespace camera_sim;

constexpr char kAbout[] =
    "Renders views of the tag on a plain panel, for studies of detectors.\n"
    "stdin   one line a view: pose x y z (m) qx qy qz qw of the tag in the optical frame (x "
    "right,\n"
    "        y down, z forward; the tag's z out of its face), its velocity vx vy vz (m/s)\n"
    "stdout  one stream of binary PGM images (P5), 8 bit";

constexpr double kPanelDepth = 0.001;   // m: the tag's box is nearly flat
constexpr double kMostInstants = 40.0;  // of an exposure; one for each pixel of blur

const Eigen::Vector3d kCameraInRoom(-1.2, 0.0, 1.3);  // m

struct View {
  Eigen::Isometry3d tag = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};

struct Params {
  PinholeCamera camera;
  double tag_size = 0.0;  // m
  double exposure = 0.0;  // s
  double noise = 0.0;     // grey levels
  Clutter clutter;
};

// All options are required.
void add_options(CLI::App& app, Params& params) {
  const auto add = [&](const std::string& name, auto& value, const std::string& meaning) {
    return app.add_option("--" + name, value, meaning)->required();
  };
  add("tag_size", params.tag_size, "m");
  add("exposure", params.exposure, "s")->check(CLI::Range(0.0, 1.0));
  add("noise", params.noise, "standard deviation, grey levels");
  add("seed", params.clutter.seed, "of noise and posters");
  add("clutter", params.clutter.posters, "posters on the walls");
  add("width", params.camera.width, "px");
  add("height", params.camera.height, "px");
  add("fx", params.camera.fx, "px");
  add("fy", params.camera.fy, "px");
  add("cx", params.camera.cx, "px");
  add("cy", params.camera.cy, "px");
  const std::array<std::string, 5> names{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    add(names[i], params.camera.distortion[i], "of plumb_bob");
  }
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
  explicit Studio(const Params& params)
      : exposure_(params.exposure),
        target_(panel(params.tag_size)),
        camera_(params.camera),
        noise_(params.noise, params.clutter.seed),
        renderer_(camera_, target_, params.clutter) {}

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
  ImageNoise noise_;
  CameraRenderer renderer_;
};

void render_all(const Params& params) {
  const Studio studio(params);
  std::string line;
  for (std::uint64_t number = 0; std::getline(std::cin, line); ++number) {
    const cv::Mat image = studio.picture(parse_view(line), number);
    std::cout << "P5\n" << image.cols << " " << image.rows << "\n255\n";
    std::cout.write(image.ptr<char>(), static_cast<std::streamsize>(image.total()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{kAbout};
  Params params;
  add_options(app, params);
  try {
    app.parse(argc, argv);
    render_all(params);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& error) {
    std::cerr << "render_tag_views: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
