// SPDX-License-Identifier: BSD-3-Clause
// The pose of the camera in the planning frame at the stamp of an image, as soon as it is final.
// Only the frames between the two count; whatever else is on tf may have any stamp.
//
// A stamp is ready when every moving frame of the chain has a sample later than the stamp. Then the
// same two neighbours are interpolated, whatever order the messages of different topics came in.
//
// Each frame has a clock of its own (prf_core/clock_monitor.hpp): a sample that is old, doubled or
// far ahead is dropped; samples in a row that say that the clock jumped start the frame anew. A
// frame keeps the parent that it has; another parent is taken when samples in a row agree on it.
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <map>
#include <optional>
#include <prf_core/clock_monitor.hpp>
#include <prf_core/se3.hpp>
#include <string>
#include <vector>

namespace prf_predictor {

class FrameChain {
 public:
  static constexpr prf_core::Duration kHistory = std::chrono::seconds(10);
  static constexpr std::size_t kMostFrames = 1000;
  static constexpr std::size_t kMostSamples = 20000;  // of one frame

  struct Transform {
    std::string parent;
    std::string child;
    prf_core::Stamp stamp{0};
    prf_core::Pose pose;  // of the child in the parent
  };

  enum class Effect {
    kStored,
    kOld,          // out of order, or too few to prove a jump of the clock
    kDuplicate,    // its stamp came before
    kFarAhead,     // too few to prove a jump
    kOtherParent,  // the frame has another one
    kBadPose,      // not finite, beyond all bounds, or no unit quaternion
    kBadFrames,    // without a name, or a frame in itself
    kTooMany,      // frames
  };

  enum class Readiness {
    kReady,
    kWait,   // later tf may bring it
    kNever,  // no later tf can bring it, or tf is more than `max_wait` past the stamp
  };

  struct LookupResult {
    Readiness readiness = Readiness::kWait;
    Eigen::Isometry3d camera_in_planning = Eigen::Isometry3d::Identity();
    std::string reason;  // when not ready
  };

  FrameChain(std::string planning_frame, prf_core::Duration max_wait);

  Effect add(const Transform& transform, bool is_static);

  // The images began a new run at this stamp: samples of the old run are dropped.
  void begin_run(prf_core::Stamp stamp);

  [[nodiscard]] LookupResult lookup(const std::string& camera_frame, prf_core::Stamp stamp) const;

  // Whether there is tf of this frame.
  [[nodiscard]] bool has(const std::string& frame) const { return frames_.count(frame) > 0; }

  // Whether this frame lies between the planning frame and `camera_frame`.
  [[nodiscard]] bool is_between(const std::string& frame, const std::string& camera_frame) const;

 private:
  struct Sample {
    prf_core::Stamp stamp{0};
    prf_core::Pose pose;
  };
  struct Frame {
    std::string parent;
    bool is_static = false;
    std::deque<Sample> samples;  // stamps rise; one when static
    prf_core::ClockMonitor clock;
    std::string other_parent;
    int other_parents = 0;  // in a row

    [[nodiscard]] std::optional<prf_core::Pose> at(prf_core::Stamp stamp) const;
  };
  // Frames from one up to below another; none: they are not connected.
  struct Chain {
    std::vector<const Frame*> to_camera;    // upwards from the camera
    std::vector<const Frame*> to_planning;  // upwards from the planning frame
    [[nodiscard]] std::vector<const Frame*> moving() const;
  };

  // Why there is no transform at the stamp: by how much the image is ahead of tf, or before it.
  [[nodiscard]] static std::string ahead_of_tf(const Chain& between, prf_core::Stamp stamp);
  [[nodiscard]] static std::string before_tf(const Chain& between, prf_core::Stamp stamp);

  [[nodiscard]] std::vector<std::string> ancestors(const std::string& frame) const;
  [[nodiscard]] std::optional<Chain> chain(const std::string& camera_frame) const;
  // Of the moving frames of the planning frame's tree.
  [[nodiscard]] std::optional<prf_core::Stamp> newest_of_tree() const;

  std::string planning_frame_;
  prf_core::Duration max_wait_;
  std::map<std::string, Frame> frames_;  // by the name of the child
};

}  // namespace prf_predictor
