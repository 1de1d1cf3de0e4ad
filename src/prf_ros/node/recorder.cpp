// SPDX-License-Identifier: BSD-3-Clause
// Records topics into one LZ4 bag and loses none of their messages:
//   recorder BAG TOPIC [TOPIC ...]
//
// Stands in for `rosbag record`, whose queue of 100 messages a topic overflows when a trial runs
// faster than the machine can write, and which says nothing about it. Until it is closed the bag is
// called BAG.active. SIGINT closes it; exit code 1 means that it could not be written.
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace {

using Event = ros::MessageEvent<topic_tools::ShapeShifter const>;

constexpr std::uint32_t kUnlimited = 0;

class Recorder {
 public:
  Recorder(const std::string& bag, const std::vector<std::string>& topics)
      : file_(bag), active_(bag + ".active"), bag_(active_, rosbag::bagmode::Write) {
    bag_.setCompression(rosbag::compression::LZ4);
    for (const std::string& topic : topics) {
      ros::SubscribeOptions options;
      options.initByFullCallbackType<const Event&>(
          topic, kUnlimited, [this, topic](const Event& event) { write(topic, event); });
      options.transport_hints.tcpNoDelay();
      subscribers_.push_back(node_.subscribe(options));
    }
  }

  void close() {
    subscribers_.clear();
    bag_.close();
    std::filesystem::rename(active_, file_);
  }

 private:
  // Before the first clock the time is 0, which no bag takes.
  void write(const std::string& topic, const Event& event) {
    bag_.write(topic, std::max(event.getReceiptTime(), ros::TIME_MIN), *event.getMessage(),
               event.getConnectionHeaderPtr());
  }

  ros::NodeHandle node_;
  std::string file_;
  std::string active_;
  rosbag::Bag bag_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "recorder");
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2) {
    ROS_FATAL("usage: recorder BAG TOPIC [TOPIC ...]");
    return 2;
  }
  std::unique_ptr<Recorder> recorder;
  try {
    recorder =
        std::make_unique<Recorder>(words.front(), std::vector(words.begin() + 1, words.end()));
    ros::spin();
    recorder->close();
  } catch (const std::exception& error) {
    ROS_FATAL("%s cannot be written: %s", words.front().c_str(), error.what());
    std::fflush(nullptr);
    std::_Exit(1);  // the destructor of a bag that cannot be written throws
  }
  return 0;
}
