// SPDX-License-Identifier: BSD-3-Clause
//
// What the fuzz targets share. A target is a function of bytes that must come back from whatever
// they are: std::invalid_argument is a refusal, anything else that escapes is a defect, as is what
// the sanitizers find.
#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fuzz {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::string text() const { return {reinterpret_cast<const char*>(at_), size_}; }
  // 0 at the end.
  std::uint8_t byte() {
    if (size_ == 0) return 0;
    --size_;
    return *at_++;
  }
  // The next `size` bytes, or what is left.
  Bytes part(std::size_t size) {
    const Bytes result(at_, std::min(size, size_));
    at_ += result.size_;
    size_ -= result.size_;
    return result;
  }

 private:
  template <typename Message>
  friend bool read(Bytes bytes, Message& message);

  const std::uint8_t* at_;
  std::size_t size_;
};

// While one lives, operator new refuses more than a megabyte at once, as nothing in a message of
// the fuzzer's size can need (main.cpp).
struct AllocationLimit {
  AllocationLimit();
  ~AllocationLimit();
};

// The message as it comes over the wire; false when the bytes are none.
template <typename Message>
bool read(Bytes bytes, Message& message) {
  const AllocationLimit limit;
  try {
    ros::serialization::IStream stream(const_cast<std::uint8_t*>(bytes.at_),
                                       static_cast<std::uint32_t>(bytes.size_));
    ros::serialization::deserialize(stream, message);
    return true;
  } catch (const ros::Exception&) {  // too few bytes
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return false;
}

// Calls for each message of the bytes (a kind, a length of two bytes, the message):
// handle(kind, bytes).
void for_each_message(Bytes bytes, const std::function<void(int, Bytes)>& handle);

// A file with these bytes whose name ends in `ending`, there until the next one.
[[nodiscard]] std::string file_with(const Bytes& bytes, const std::string& ending);

// Runs what may refuse its input in one line of text; true when it did not.
bool accepts(const std::function<void()>& use);

// A defect unless `holds`: prints what was expected and aborts, which the fuzzer keeps.
inline void expect(bool holds, const char* expected) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", expected);
  std::abort();
}

using Run = void (*)(Bytes);
struct Target {
  Target(const char* name, Run run);  // registers it
};

}  // namespace fuzz

#define FUZZ_TARGET(name)                               \
  static void name(fuzz::Bytes bytes);                  \
  static const fuzz::Target target_##name(#name, name); \
  static void name(fuzz::Bytes bytes)
