// SPDX-License-Identifier: BSD-3-Clause
// Draws the scene of a recorded run at one instant.
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "scene_recording.hpp"

namespace {

constexpr char kUsage[] =
    "usage: scene_picture URDF BAG TIME OUT.png\n"
    "  draws robot, platform or cart, and target at TIME (simulated s) from the bag's "
    "joint_states\n"
    "  and ground_truth/{platform,base,tag}\n";
constexpr int kWidth = 1280;  // px

void draw(const std::string& urdf_path, const std::string& bag_path, const std::string& time,
          const std::string& out_path) {
  const double instant = scene_drawing::to_number("TIME", time, 0.0, 1e6);
  const scene_drawing::SceneRecording scene = scene_drawing::read_scene(bag_path);
  const cv::Mat image = scene_drawing::draw_overview(
      scene_drawing::make_renderer(urdf_path, scene.target), scene.at(instant), kWidth);
  if (!cv::imwrite(out_path, image)) throw std::invalid_argument("cannot write " + out_path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    draw(argv[1], argv[2], argv[3], argv[4]);
  } catch (const std::exception& error) {
    std::cerr << "scene_picture: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
