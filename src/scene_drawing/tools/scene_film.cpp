// SPDX-License-Identifier: BSD-3-Clause
// Draws a recorded run as a film whose time is the run's: scene, hand camera, clock and state.
#include <prf_msgs/ExecutionProgress.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <prf_ros/bag.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene_recording.hpp"

namespace {

constexpr char kUsage[] =
    "usage: scene_film URDF BAG OUT.mp4 RATE\n"
    "  draws the whole run, RATE (1..30) pictures for each simulated second, 960x480: the scene,\n"
    "  beside it the hand camera, the time and the state of the execution\n";
constexpr int kSceneWidth = 640;  // px
constexpr int kSceneHeight = 480;
constexpr int kSideWidth = 320;
const cv::Scalar kPaper(243, 240, 238);
const cv::Scalar kInk(25, 20, 20);

// What stands beside the scene from one instant on.
struct Side {
  cv::Mat image;  // of the hand camera, grey, kSideWidth wide; empty: none yet
  std::string state;
};

std::string name_of(std::uint8_t state) {
  using prf_msgs::ExecutionProgress;
  static const std::array<std::pair<std::uint8_t, const char*>, 9> kNames{
      {{ExecutionProgress::WAITING, "WAITING"},
       {ExecutionProgress::FORWARD, "FORWARD"},
       {ExecutionProgress::PAUSE, "PAUSE"},
       {ExecutionProgress::REVERSE, "REVERSE"},
       {ExecutionProgress::TRACKING, "TRACKING"},
       {ExecutionProgress::RETRACT, "RETRACT"},
       {ExecutionProgress::DONE, "DONE"},
       {ExecutionProgress::STOPPED, "STOPPED"},
       {ExecutionProgress::SEARCH, "SEARCH"}}};
  const auto* found = std::find_if(kNames.begin(), kNames.end(),
                                   [&](const auto& entry) { return entry.first == state; });
  return found == kNames.end() ? "state " + std::to_string(state) : found->second;
}

// Small, grey; empty when its encoding has not one byte a pixel.
cv::Mat small_picture(const sensor_msgs::Image& message) {
  const auto height = static_cast<int>(message.height);
  const auto width = static_cast<int>(message.width);
  if (message.encoding != "mono8" || width == 0 || height == 0 || message.step < message.width ||
      message.data.size() < std::size_t{message.step} * message.height) {
    return {};
  }
  const cv::Mat whole(height, width, CV_8UC1, const_cast<std::uint8_t*>(message.data.data()),
                      message.step);
  cv::Mat small;
  cv::resize(whole, small, {kSideWidth, std::min(kSceneHeight / 2, height * kSideWidth / width)}, 0,
             0, cv::INTER_AREA);
  return small;
}

// What stands beside the scene at the times, s, which rise.
std::vector<Side> sides_at(const std::string& bag_path, const std::vector<double>& times) {
  rosbag::Bag bag;
  prf_ros::open_bag(bag, bag_path);
  rosbag::View view(bag, rosbag::TopicQuery(
                             std::vector<std::string>{"/camera/image_raw", "/execution/progress"}));
  std::vector<Side> sides(times.size());
  const auto first_after = [&](const ros::Time& stamp) {
    return static_cast<std::size_t>(
        std::lower_bound(times.begin(), times.end(), stamp.toSec() - 1e-6) - times.begin());
  };
  std::size_t drawn = times.size();  // the row that the latest image belongs to
  sensor_msgs::Image::ConstPtr latest;
  const auto keep = [&] {
    if (latest && drawn < times.size()) sides[drawn].image = small_picture(*latest);
  };
  for (const rosbag::MessageInstance& instance : view) {
    if (const auto progress = prf_ros::message_in<prf_msgs::ExecutionProgress>(instance)) {
      const std::size_t row = first_after(progress->header.stamp);
      if (row < times.size()) sides[row].state = name_of(progress->state);
    } else if (const auto image = prf_ros::message_in<sensor_msgs::Image>(instance)) {
      const std::size_t row = first_after(image->header.stamp);
      if (row != drawn) keep();  // of the images before one time the last one is shown
      latest = image;
      drawn = row;
    }
  }
  keep();
  for (std::size_t row = 1; row < sides.size(); ++row) {
    if (sides[row].image.empty()) sides[row].image = sides[row - 1].image;
    if (sides[row].state.empty()) sides[row].state = sides[row - 1].state;
  }
  return sides;
}

cv::Mat compose(const cv::Mat& scene, const Side& side, double time) {
  cv::Mat whole(kSceneHeight, kSceneWidth + kSideWidth, CV_8UC3, kPaper);
  scene.copyTo(whole({0, 0, kSceneWidth, kSceneHeight}));
  if (!side.image.empty()) {
    cv::Mat coloured;
    cv::cvtColor(side.image, coloured, cv::COLOR_GRAY2BGR);
    coloured.copyTo(whole({kSceneWidth, 0, coloured.cols, coloured.rows}));
  }
  cv::putText(whole, cv::format("%.1f s", time), {kSceneWidth + 20, 330}, cv::FONT_HERSHEY_SIMPLEX,
              2.0, kInk, 4, cv::LINE_AA);
  cv::putText(whole, side.state, {kSceneWidth + 20, 400}, cv::FONT_HERSHEY_SIMPLEX, 1.2, kInk, 2,
              cv::LINE_AA);
  return whole;
}

void draw(const std::string& urdf_path, const std::string& bag_path, const std::string& out_path,
          const std::string& rate_text) {
  const double rate = scene_drawing::to_number("RATE", rate_text, 1, 30);
  const scene_drawing::SceneRecording scene = scene_drawing::read_scene(bag_path);
  const scene_drawing::SceneRenderer renderer =
      scene_drawing::make_renderer(urdf_path, scene.target);
  const double begin = 1e-9 * static_cast<double>(scene.states.begin()->first);
  std::vector<double> times;
  for (int i = 0; begin + i / rate <= scene.end() + 1e-6; ++i) times.push_back(begin + i / rate);
  const std::vector<Side> sides = sides_at(bag_path, times);

  // H.264 plays in every browser.
  cv::VideoWriter film(out_path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('a', 'v', 'c', '1'), rate,
                       {kSceneWidth + kSideWidth, kSceneHeight});
  if (!film.isOpened()) {
    throw std::runtime_error("cannot write " + out_path +
                             ": must end with .mp4 in a folder that can be written, and OpenCV's "
                             "FFmpeg must have H.264");
  }
  for (std::size_t row = 0; row < times.size(); ++row) {
    film.write(compose(scene_drawing::draw_overview(renderer, scene.at(times[row]), kSceneWidth),
                       sides[row], times[row] - begin));
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
    std::cerr << "scene_film: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
