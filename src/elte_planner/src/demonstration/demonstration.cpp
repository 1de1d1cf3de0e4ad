// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/demonstration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace elte_planner {
namespace {

[[noreturn]] void refuse_demonstration(const std::string& what) {
  throw std::invalid_argument("demonstration: " + what);
}

template <typename Value>
std::string text(const Value& value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

Pose normalised(const Pose& pose, const std::string& where) {
  if (!pose.is_finite()) refuse_demonstration(where + " has a coordinate that is not finite");
  const double farthest = pose.position.cwiseAbs().maxCoeff();
  if (!(farthest <= Demonstration::kMaxCoordinate)) {
    refuse_demonstration(where + " has a coordinate of " + text(farthest) + " m, must be at most " +
                         text(Demonstration::kMaxCoordinate) + " m");
  }
  const double norm = pose.orientation.norm();
  if (!(std::abs(norm - 1.0) <= prf_core::kUnitQuaternionTolerance)) {
    refuse_demonstration(where + " has a quaternion of norm " + text(norm) + ", must be within " +
                         text(prf_core::kUnitQuaternionTolerance) + " of 1");
  }
  return {pose.position, pose.orientation.normalized()};
}

std::vector<double> arc_lengths(const std::vector<TimedPose>& samples) {
  std::vector<double> arc(samples.size(), 0.0);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    arc[i] = arc[i - 1] + (samples[i].pose.position - samples[i - 1].pose.position).norm();
  }
  return arc;
}

TimedPose interpolated(const TimedPose& a, const TimedPose& b, double fraction) {
  return {a.time + fraction * (b.time - a.time),
          {a.pose.position + fraction * (b.pose.position - a.pose.position),
           a.pose.orientation.slerp(fraction, b.pose.orientation)}};
}

double distance_from_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& to) {
  const Eigen::Vector3d along = to - from;
  const double square = along.squaredNorm();
  const double share = square > 0.0 ? std::clamp(along.dot(point - from) / square, 0.0, 1.0) : 0.0;
  return (point - from - share * along).norm();
}

// Samples between two that are taken, and the one of them farthest from the line.
struct Gap {
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t farthest = 0;
  double distance = -1.0;

  bool operator<(const Gap& other) const {
    return std::make_pair(distance, last - first) <
           std::make_pair(other.distance, other.last - other.first);
  }
};

Gap gap_between(std::size_t first, std::size_t last, const std::vector<TimedPose>& samples) {
  Gap gap{first, last, first, -1.0};
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance = distance_from_segment(
        samples[i].pose.position, samples[first].pose.position, samples[last].pose.position);
    if (distance > gap.distance) {
      gap.farthest = i;
      gap.distance = distance;
    }
  }
  return gap;
}

}  // namespace

Demonstration::Demonstration(std::vector<TimedPose> samples, std::string frame,
                             std::string child_frame, const Pose& target, Notes notes)
    : samples_(std::move(samples)),
      frame_(std::move(frame)),
      child_frame_(std::move(child_frame)),
      target_(normalised(target, "target_pose")),
      notes_(std::move(notes)) {
  if (frame_.empty()) refuse_demonstration("frame is empty, must name the frame of the poses");
  if (child_frame_.empty())
    refuse_demonstration("child_frame is empty, must name the guided frame");
  if (samples_.size() < kMinSamples || samples_.size() > kMaxSamples) {
    refuse_demonstration("has " + text(samples_.size()) + " samples, must have at least " +
                         text(kMinSamples) + " and at most " + text(kMaxSamples));
  }
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const std::string where = "sample " + text(i);
    if (!std::isfinite(samples_[i].time))
      refuse_demonstration(where + " has a time that is not finite");
    if (samples_[i].time > kMaxTime) {
      refuse_demonstration(where + " has time " + text(samples_[i].time) + " s, must be at most " +
                           text(kMaxTime) + " s");
    }
    if (i == 0 && samples_[i].time != 0.0) {
      refuse_demonstration(where + " has time " + text(samples_[i].time) + " s, must be 0");
    }
    if (i > 0 && !(samples_[i].time > samples_[i - 1].time)) {
      refuse_demonstration(where + " has time " + text(samples_[i].time) + " s, must be above " +
                           text(samples_[i - 1].time) + " s of the sample before");
    }
    samples_[i].pose = normalised(samples_[i].pose, where);
  }
  if (!(length() >= kMinLength)) {
    refuse_demonstration("has a path " + text(length()) +
                         " m long (all points repeated), must be at least " + text(kMinLength) +
                         " m");
  }
}

Pose Demonstration::goal_in_target() const {
  return prf_core::pose_from(target_.isometry().inverse() * samples_.back().pose.isometry());
}

Demonstration Demonstration::with_samples(std::vector<TimedPose> samples) const {
  return Demonstration(std::move(samples), frame_, child_frame_, target_, notes_);
}

Eigen::MatrixXd Demonstration::positions() const {
  Eigen::MatrixXd result(samples_.size(), 3);
  Eigen::Index row = 0;
  for (const TimedPose& sample : samples_) {
    result.row(row++) = sample.pose.position.transpose();
  }
  return result;
}

double Demonstration::length() const { return arc_lengths(samples_).back(); }

Demonstration Demonstration::resampled_by_arc_length(std::size_t nodes) const {
  if (nodes < kMinSamples) {
    refuse_demonstration("resampling to " + text(nodes) + " nodes, must be at least " +
                         text(kMinSamples));
  }
  const std::vector<double> arc = arc_lengths(samples_);
  std::vector<TimedPose> result;
  result.reserve(nodes);
  result.push_back(samples_.front());
  for (std::size_t k = 1; k + 1 < nodes; ++k) {
    const double length = arc.back() * static_cast<double>(k) / static_cast<double>(nodes - 1);
    const auto after = std::upper_bound(arc.begin() + 1, arc.end() - 1, length);
    const auto i = static_cast<std::size_t>(after - arc.begin());
    const double fraction = std::clamp((length - arc[i - 1]) / (arc[i] - arc[i - 1]), 0.0, 1.0);
    result.push_back(interpolated(samples_[i - 1], samples_[i], fraction));
  }
  result.push_back(samples_.back());
  return with_samples(std::move(result));
}

// Takes the sample farthest from the lines between those taken until
// is_enough(samples taken, the farthest one's distance).
template <typename IsEnough>
Demonstration Demonstration::subdivided(IsEnough&& is_enough) const {
  std::vector<bool> taken(samples_.size(), false);
  taken.front() = taken.back() = true;
  std::priority_queue<Gap> gaps;
  gaps.push(gap_between(0, samples_.size() - 1, samples_));
  for (std::size_t count = 2; !is_enough(count, gaps.top().distance); ++count) {
    const Gap widest = gaps.top();
    gaps.pop();
    taken[widest.farthest] = true;
    gaps.push(gap_between(widest.first, widest.farthest, samples_));
    gaps.push(gap_between(widest.farthest, widest.last, samples_));
  }
  std::vector<TimedPose> result;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (taken[i]) result.push_back(samples_[i]);
  }
  return with_samples(std::move(result));
}

Demonstration Demonstration::resampled_by_douglas_peucker(std::size_t nodes) const {
  if (nodes < kMinSamples || nodes > samples_.size()) {
    refuse_demonstration("resampling to " + text(nodes) + " nodes, must be within [" +
                         text(kMinSamples) + ", " + text(samples_.size()) +
                         "], the number of samples");
  }
  return subdivided([nodes](std::size_t count, double) { return count == nodes; });
}

Demonstration Demonstration::thinned_by_douglas_peucker(double tolerance) const {
  if (!(tolerance >= 0.0)) {
    refuse_demonstration("thinning tolerance is " + text(tolerance) + " m, must be at least 0 m");
  }
  return subdivided([tolerance](std::size_t count, double farthest) {
    return count >= kMinSamples && farthest <= tolerance;
  });
}

}  // namespace elte_planner
