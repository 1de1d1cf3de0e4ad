// SPDX-License-Identifier: BSD-3-Clause
// Draws the scene of a recorded run at some instants.
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene_recording.hpp"

namespace {

constexpr char kUsage[] =
    "usage: scene_picture URDF BAG TIME OUT.png [TIME OUT.png ...]\n"
    "  draws robot, platform or cart, and target at TIME (simulated s) from the bag's "
    "joint_states\n"
    "  and ground_truth/{platform,base,tag}\n";
constexpr int kWidth = 1280;  // px

// words: TIME OUT.png, again and again.
void draw(const std::string& urdf_path, const std::string& bag_path,
          const std::vector<std::string>& words) {
  const scene_drawing::SceneRecording scene = scene_drawing::read_scene(bag_path);
  const scene_drawing::SceneRenderer renderer =
      scene_drawing::make_renderer(urdf_path, scene.target);
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    const double instant = scene_drawing::to_number("TIME", words[i], 0.0, 1e6);
    const cv::Mat image = scene_drawing::draw_overview(renderer, scene.at(instant), kWidth);
    if (!cv::imwrite(words[i + 1], image)) {
      throw std::invalid_argument(
          "cannot write " + words[i + 1] +
          ": must be a picture, as OUT.png, in a folder that can be written");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5 || argc % 2 == 0) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    draw(argv[1], argv[2], {argv + 3, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "scene_picture: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
