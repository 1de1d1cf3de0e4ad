// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/execution_cursor.hpp"

#include <algorithm>
#include <prf_core/require.hpp>

namespace prf_decision {
namespace {

double last_node(const Trajectory& trajectory) {
  return static_cast<double>(trajectory.poses.size() - 1);
}

struct Segment {
  std::size_t node;  // where it starts
  double fraction;   // of its time, 0 .. 1
};

Segment segment_at(const Trajectory& trajectory, double cursor) {
  prf_core::require_between("cursor", cursor, 0, last_node(trajectory), "nodes");
  const std::size_t node = std::min(static_cast<std::size_t>(cursor), trajectory.poses.size() - 2);
  return {node, cursor - static_cast<double>(node)};
}

Duration span(const Trajectory& trajectory, std::size_t node) {
  return trajectory.times[node + 1] - trajectory.times[node];
}

Duration time_at(const Trajectory& trajectory, double cursor) {
  const auto [node, fraction] = segment_at(trajectory, cursor);
  return trajectory.times[node] + from_seconds(fraction * to_seconds(span(trajectory, node)));
}

Eigen::Vector3d chord_velocity(const Trajectory& trajectory, std::size_t node) {
  return (trajectory.poses[node + 1].position - trajectory.poses[node].position) /
         to_seconds(span(trajectory, node));
}

}  // namespace

double advance_cursor(const Trajectory& trajectory, double cursor, Direction direction,
                      Duration dt) {
  if (direction == Direction::kStand) return cursor;
  const auto& times = trajectory.times;
  const Duration step = static_cast<int>(direction) * dt;
  const Duration time = std::clamp(time_at(trajectory, cursor) + step, Duration{0}, times.back());
  if (time == times.back()) return last_node(trajectory);
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  const auto node = static_cast<std::size_t>(std::distance(times.begin(), next)) - 1;
  return static_cast<double>(node) +
         to_seconds(time - times[node]) / to_seconds(span(trajectory, node));
}

std::size_t frozen_nodes(const Trajectory& trajectory, double cursor) {
  return std::min(static_cast<std::size_t>(cursor) + 2, trajectory.poses.size());
}

Duration time_to_go(const Trajectory& trajectory, double cursor) {
  return trajectory.times.back() - time_at(trajectory, cursor);
}

bool at_end(const Trajectory& trajectory, double cursor) { return cursor >= last_node(trajectory); }

MovingPose hand_at(const Trajectory& trajectory, double cursor, Direction direction) {
  const auto [node, fraction] = segment_at(trajectory, cursor);
  const Eigen::Vector3d arriving = chord_velocity(trajectory, node == 0 ? 0 : node - 1);
  const MovingPose start{trajectory.poses[node], arriving, {0, 0, 0}};
  const MovingPose end{trajectory.poses[node + 1], chord_velocity(trajectory, node), {0, 0, 0}};
  const double seconds = to_seconds(span(trajectory, node));
  MovingPose hand = prf_core::interpolate(start, end, seconds, fraction * seconds);
  const double sign = static_cast<double>(static_cast<int>(direction));
  hand.linear_velocity *= sign;
  hand.angular_velocity *= sign;
  return hand;
}

}  // namespace prf_decision
