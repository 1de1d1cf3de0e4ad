// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/frame_chain.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <prf_core/quoted.hpp>
#include <sstream>
#include <utility>

namespace prf_predictor {
namespace {

using prf_core::Duration;
using prf_core::Pose;
using prf_core::Stamp;
using prf_core::StampOrder;

constexpr double kFarthest = 1e4;        // m, of one frame in another
constexpr double kNormTolerance = 0.01;  // of a quaternion
constexpr int kParentConfirmations = 3;
constexpr std::size_t kDeepest = 200;  // frames in a row
constexpr Duration kLateness = std::chrono::milliseconds(500);

bool is_pose(const Pose& pose) {
  return pose.is_finite() && pose.position.cwiseAbs().maxCoeff() <= kFarthest &&
         std::abs(pose.orientation.norm() - 1.0) <= kNormTolerance;
}

std::string shown(const std::string& frame) { return prf_core::quoted(frame); }

std::string seconds(Duration duration) {
  std::ostringstream text;
  text << std::setprecision(3) << prf_core::to_seconds(duration);
  return text.str();
}

// Too far apart for a message that is merely late.
const char* clocks(Duration apart) {
  return apart > kLateness ? ": are the clocks of camera and robot synchronised?" : "";
}

}  // namespace

FrameChain::FrameChain(std::string planning_frame, Duration max_wait)
    : planning_frame_(std::move(planning_frame)), max_wait_(max_wait) {}

FrameChain::Effect FrameChain::add(const Transform& transform, bool is_static) {
  if (transform.parent.empty() || transform.child.empty() || transform.parent == transform.child) {
    return Effect::kBadFrames;
  }
  if (!is_pose(transform.pose)) return Effect::kBadPose;
  const bool is_new = frames_.count(transform.child) == 0;
  if (is_new && frames_.size() >= kMostFrames) return Effect::kTooMany;
  Frame& frame = frames_[transform.child];
  if (is_new) {
    frame.parent = transform.parent;
    frame.is_static = is_static;
  } else if (frame.parent != transform.parent || frame.is_static != is_static) {
    frame.other_parents = frame.other_parent == transform.parent ? frame.other_parents + 1 : 1;
    frame.other_parent = transform.parent;
    if (!is_static && frame.other_parents < kParentConfirmations) return Effect::kOtherParent;
    Frame fresh;
    fresh.parent = transform.parent;
    frame = fresh;
    frame.is_static = is_static;
  }
  frame.other_parents = 0;
  const Pose pose{transform.pose.position, transform.pose.orientation.normalized()};
  if (is_static) {
    frame.samples = {{transform.stamp, pose}};
    return Effect::kStored;
  }
  const StampOrder order = frame.clock.observe(transform.stamp);
  if (order == StampOrder::kDuplicate) return Effect::kDuplicate;
  if (order == StampOrder::kFarAhead) return Effect::kFarAhead;
  if (!prf_core::is_accepted(order)) return Effect::kOld;
  if (order != StampOrder::kNewer) frame.samples.clear();
  frame.samples.push_back({transform.stamp, pose});
  while (transform.stamp - frame.samples.front().stamp > kHistory ||
         frame.samples.size() > kMostSamples) {
    frame.samples.pop_front();
  }
  return Effect::kStored;
}

void FrameChain::begin_run(Stamp stamp) {
  for (auto& [name, frame] : frames_) {
    if (frame.is_static || !frame.clock.jumps_back(stamp)) continue;
    frame.samples.clear();
    frame.clock.restart();
  }
}

std::optional<Pose> FrameChain::Frame::at(Stamp stamp) const {
  if (samples.empty()) return std::nullopt;
  if (is_static) return samples.front().pose;
  const auto after = std::lower_bound(samples.begin(), samples.end(), stamp,
                                      [](const Sample& s, Stamp t) { return s.stamp < t; });
  if (after == samples.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == samples.begin()) return std::nullopt;
  const Sample& before = *std::prev(after);
  const double fraction = prf_core::to_seconds(stamp - before.stamp) /
                          prf_core::to_seconds(after->stamp - before.stamp);
  return Pose{before.pose.position + fraction * (after->pose.position - before.pose.position),
              before.pose.orientation.slerp(fraction, after->pose.orientation)};
}

std::vector<const FrameChain::Frame*> FrameChain::Chain::moving() const {
  std::vector<const Frame*> result;
  for (const auto& side : {to_camera, to_planning}) {
    for (const Frame* frame : side) {
      if (!frame->is_static) result.push_back(frame);
    }
  }
  return result;
}

std::string FrameChain::ahead_of_tf(const Chain& between, Stamp stamp) {
  for (const Frame* frame : between.moving()) {
    const auto newest = frame->samples.empty() ? std::nullopt : frame->clock.newest();
    if (!newest) return "no tf yet from " + shown(frame->parent);
    if (*newest > stamp) continue;
    return "the image's stamp is " + seconds(stamp - *newest) + " s ahead of the newest tf from " +
           shown(frame->parent) + clocks(stamp - *newest);
  }
  return "";
}

std::string FrameChain::before_tf(const Chain& between, Stamp stamp) {
  for (const Frame* frame : between.moving()) {
    if (frame->samples.empty() || frame->samples.front().stamp <= stamp) continue;
    const Duration behind = frame->samples.front().stamp - stamp;
    return ", which is " + seconds(behind) + " s before the oldest tf from " +
           shown(frame->parent) + clocks(behind);
  }
  return "";
}

// The frame itself first, the root of its tree last. A loop ends after kDeepest.
std::vector<std::string> FrameChain::ancestors(const std::string& frame) const {
  std::vector<std::string> result{frame};
  for (auto found = frames_.find(frame); found != frames_.end() && result.size() < kDeepest;
       found = frames_.find(found->second.parent)) {
    result.push_back(found->second.parent);
  }
  return result;
}

std::optional<FrameChain::Chain> FrameChain::chain(const std::string& camera_frame) const {
  const auto up_from_camera = ancestors(camera_frame);
  const auto up_from_planning = ancestors(planning_frame_);
  const auto meeting = std::find_first_of(up_from_camera.begin(), up_from_camera.end(),
                                          up_from_planning.begin(), up_from_planning.end());
  if (meeting == up_from_camera.end()) return std::nullopt;
  Chain result;
  for (auto name = up_from_camera.begin(); name != meeting; ++name) {
    result.to_camera.push_back(&frames_.at(*name));
  }
  for (auto name = up_from_planning.begin(); *name != *meeting; ++name) {
    result.to_planning.push_back(&frames_.at(*name));
  }
  return result;
}

bool FrameChain::is_between(const std::string& frame, const std::string& camera_frame) const {
  const auto found = frames_.find(frame);
  const auto between = chain(camera_frame);
  if (found == frames_.end() || !between) return false;
  const auto has = [&](const std::vector<const Frame*>& side) {
    return std::find(side.begin(), side.end(), &found->second) != side.end();
  };
  return has(between->to_camera) || has(between->to_planning);
}

std::optional<Stamp> FrameChain::newest_of_tree() const {
  const std::string root = ancestors(planning_frame_).back();
  std::optional<Stamp> newest;
  for (const auto& [name, frame] : frames_) {
    if (frame.is_static || frame.samples.empty() || ancestors(name).back() != root) continue;
    newest = std::max(newest.value_or(frame.samples.back().stamp), frame.samples.back().stamp);
  }
  return newest;
}

FrameChain::LookupResult FrameChain::lookup(const std::string& camera_frame, Stamp stamp) const {
  LookupResult result;
  const auto between = chain(camera_frame);
  if (!between) {
    const auto newest = newest_of_tree();
    const bool has_static = std::any_of(frames_.begin(), frames_.end(),
                                        [](const auto& f) { return f.second.is_static; });
    const bool tree_is_known = has_static && newest && *newest > stamp;
    const bool is_decided = tree_is_known || (newest && *newest > stamp + max_wait_);
    result.readiness = is_decided ? Readiness::kNever : Readiness::kWait;
    result.reason =
        "\"" + camera_frame.substr(0, 200) + "\" is not connected to " + planning_frame_;
    return result;
  }
  bool all_later = true;
  bool waited = false;
  for (const Frame* frame : between->moving()) {
    const auto newest = frame->samples.empty() ? std::nullopt : frame->clock.newest();
    all_later = all_later && newest && *newest > stamp;
    waited = waited || (newest && *newest > stamp + max_wait_);
  }
  if (!all_later && !waited) {
    result.reason = ahead_of_tf(*between, stamp);
    return result;
  }
  const auto compose = [&](const std::vector<const Frame*>& side) {
    std::optional<Eigen::Isometry3d> in_root = Eigen::Isometry3d::Identity();
    for (const Frame* frame : side) {
      const auto pose = frame->at(stamp);
      if (!pose) return std::optional<Eigen::Isometry3d>{};
      in_root = pose->isometry() * *in_root;
    }
    return in_root;
  };
  const auto camera = compose(between->to_camera);
  const auto planning = compose(between->to_planning);
  if (camera && planning) {
    result.readiness = Readiness::kReady;
    result.camera_in_planning = planning->inverse() * *camera;
  } else {
    result.readiness = Readiness::kNever;
    result.reason = "no transform between " + planning_frame_ + " and \"" +
                    camera_frame.substr(0, 200) + "\" at the stamp of the image" +
                    before_tf(*between, stamp);
  }
  return result;
}

}  // namespace prf_predictor
