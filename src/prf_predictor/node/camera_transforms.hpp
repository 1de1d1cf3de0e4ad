// SPDX-License-Identifier: BSD-3-Clause
// tf messages to a FrameChain, and what is wrong with those that concern the camera.
#pragma once

#include <tf2_msgs/TFMessage.h>

#include <map>
#include <string>

#include "health.hpp"
#include "prf_predictor/frame_chain.hpp"

namespace prf_predictor {

class CameraTransforms {
 public:
  // Frames whose names begin with `ignored_prefix` are not stored: the detector sends them.
  CameraTransforms(const std::string& planning_frame, std::string ignored_prefix,
                   prf_core::Duration max_wait, Health& health);

  void add(const tf2_msgs::TFMessage& message, const std::string& publisher, bool is_static);
  void begin_run(prf_core::Stamp stamp) { chain_.begin_run(stamp); }

  // Remembers the camera: from then on drops of its frames are reported.
  [[nodiscard]] FrameChain::LookupResult lookup(const std::string& camera_frame,
                                                prf_core::Stamp stamp);

 private:
  void report(const FrameChain::Transform& transform, FrameChain::Effect effect,
              const std::string& publisher);

  FrameChain chain_;
  std::string ignored_prefix_;
  Health& health_;
  std::string camera_frame_;
  std::map<std::string, std::string> publishers_;  // of each frame, the latest
};

}  // namespace prf_predictor
