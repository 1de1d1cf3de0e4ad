// SPDX-License-Identifier: BSD-3-Clause
// Draws the scene of a recorded run at evenly spaced instants, for scene_animation.
#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "scene_recording.hpp"

namespace {

constexpr char kUsage[] =
    "usage: scene_frames URDF BAG COUNT WIDTH\n"
    "  writes COUNT pictures of the run, WIDTH pixels wide, from its start to its end, to "
    "standard\n"
    "  output as one stream of PPM images (P6), each with a comment `# time SECONDS`\n";

void write_ppm(double time, const cv::Mat& bgr) {
  cv::Mat rgb;
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  std::cout << "P6\n# time " << time << "\n" << rgb.cols << " " << rgb.rows << "\n255\n";
  std::cout.write(rgb.ptr<char>(), static_cast<std::streamsize>(rgb.total() * rgb.elemSize()));
  if (!std::cout.flush()) throw std::runtime_error("nobody reads the pictures");
}

void draw(const std::string& urdf_path, const std::string& bag_path, const std::string& count_text,
          const std::string& width_text) {
  const auto count = static_cast<int>(scene_drawing::to_number("COUNT", count_text, 2, 10000));
  const auto width = static_cast<int>(scene_drawing::to_number("WIDTH", width_text, 64, 4096));
  const scene_drawing::SceneRecording scene = scene_drawing::read_scene(bag_path);
  const scene_drawing::SceneRenderer renderer =
      scene_drawing::make_renderer(urdf_path, scene.target);
  const double begin = 1e-9 * static_cast<double>(scene.states.begin()->first);
  for (int i = 0; i < count; ++i) {
    const double time = begin + (scene.end() - begin) * i / (count - 1);
    write_ppm(time, scene_drawing::draw_overview(renderer, scene.at(time), width));
  }
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
    std::cerr << "scene_frames: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
