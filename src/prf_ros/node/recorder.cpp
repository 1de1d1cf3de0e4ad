// SPDX-License-Identifier: BSD-3-Clause
// Records topics into one bag and loses none of their messages:
//   recorder [--lz4] BAG TOPIC [TOPIC ...]
//
// With --lz4 it compresses, which finds next to nothing in images with noise.
//
// Stands in for `rosbag record`, whose queue of 100 messages a topic overflows when a trial runs
// faster than the machine can write, and which says nothing about it. Until it is closed the bag is
// called BAG.active. SIGINT closes it; exit code 1 means that it could not be written.
//
// A full disk and a folder that vanishes end it at once, with one line that says which. The bag is
// then no bag: what there is of it stays under the name BAG.active, and BAG does not appear.
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Event = ros::MessageEvent<topic_tools::ShapeShifter const>;

constexpr std::uint32_t kUnlimited = 0;
constexpr double kCheckPeriod = 0.5;              // s, wall time
constexpr std::uintmax_t kReserve = 64ULL << 20;  // bytes: less is a full disk, before it is one

class Recorder {
 public:
  Recorder(const std::string& bag, const std::vector<std::string>& topics, bool compress)
      : file_(bag), active_(bag + ".active"), bag_(active_, rosbag::bagmode::Write) {
    require_space();
    if (compress) bag_.setCompression(rosbag::compression::LZ4);
    for (const std::string& topic : topics) {
      ros::SubscribeOptions options;
      options.initByFullCallbackType<const Event&>(
          topic, kUnlimited, [this, topic](const Event& event) { write(topic, event); });
      options.transport_hints.tcpNoDelay();
      subscribers_.push_back(node_.subscribe(options));
    }
    timer_ = node_.createWallTimer(ros::WallDuration(kCheckPeriod),
                                   [this](const ros::WallTimerEvent&) { check(); });
  }

  void close() {
    subscribers_.clear();
    bag_.close();
    check();
    std::filesystem::rename(active_, file_);
  }

 private:
  // Before the first clock the time is 0, which no bag takes.
  void write(const std::string& topic, const Event& event) {
    bag_.write(topic, std::max(event.getReceiptTime(), ros::TIME_MIN), *event.getMessage(),
               event.getConnectionHeaderPtr());
  }

  // rosbag writes through a buffer: it may learn late, or only when closing, that nothing arrives.
  void check() const {
    if (!std::filesystem::exists(active_)) {
      throw std::runtime_error("the file or its folder has vanished");
    }
    require_space();
  }

  void require_space() const {
    const auto folder = std::filesystem::absolute(active_).parent_path();
    const std::uintmax_t left = std::filesystem::space(folder).available;
    if (left >= kReserve) return;
    throw std::runtime_error("the disk is full: " + std::to_string(left >> 20) +
                             " MiB left, at least " + std::to_string(kReserve >> 20) + " needed");
  }

  ros::NodeHandle node_;
  std::string file_;
  std::string active_;
  rosbag::Bag bag_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "recorder");
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool compress = !words.empty() && words.front() == "--lz4";
  if (compress) words.erase(words.begin());
  if (words.size() < 2) {
    ROS_FATAL("usage: recorder [--lz4] BAG TOPIC [TOPIC ...]");
    return 2;
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error to report
  ros::start();                   // before the handle of the recorder, so that the log outlives it
  std::string reason;
  std::unique_ptr<Recorder> recorder;
  try {
    recorder = std::make_unique<Recorder>(
        words.front(), std::vector<std::string>(words.begin() + 1, words.end()), compress);
    ros::spin();
    recorder->close();
    return 0;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  ROS_FATAL("%s cannot be written: %s", words.front().c_str(), reason.c_str());
  ros::shutdown();
  std::_Exit(1);  // a bag that cannot be written throws again when it is destroyed
}
