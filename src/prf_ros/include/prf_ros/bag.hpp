// SPDX-License-Identifier: BSD-3-Clause
// Bags as people have them, read by a tool in C++: each refusal is one line with the file's name.
// Who includes this links rosbag_storage.
#pragma once

#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace prf_ros {

// Throws std::invalid_argument for what is no bag, and says what helps with one that was not
// closed.
inline void open_bag(rosbag::Bag& bag, const std::string& path) {
  if (!std::filesystem::exists(path)) {
    throw std::invalid_argument(path + ": there is no such bag");
  }
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw std::invalid_argument(path + ": the bag was not closed; `rosbag reindex " + path +
                                "` brings back what was recorded until then");
  } catch (const rosbag::BagException& error) {
    throw std::invalid_argument(path + ": cannot be read: " + error.what());
  }
}

// The message when it is of this type, else null. instantiate() passes over a message of the type's
// name and another version's definition: that throws std::invalid_argument with the topic.
template <typename Message>
boost::shared_ptr<Message> message_in(const rosbag::MessageInstance& instance) {
  namespace traits = ros::message_traits;
  if (instance.getDataType() != traits::datatype<Message>()) return {};
  if (instance.getMD5Sum() != traits::md5sum<Message>()) {
    throw std::invalid_argument("topic " + instance.getTopic() + " holds another version's " +
                                instance.getDataType() + ": its md5 is " + instance.getMD5Sum() +
                                ", must be " + traits::md5sum<Message>());
  }
  return instance.instantiate<Message>();
}

}  // namespace prf_ros
