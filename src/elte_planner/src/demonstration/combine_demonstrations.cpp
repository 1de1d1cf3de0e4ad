// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/combine_demonstrations.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace elte_planner {
namespace {

using Samples = std::vector<TimedPose>;

Samples moved(const Demonstration& demonstration, const Eigen::Isometry3d& motion) {
  Samples samples = demonstration.samples();
  for (TimedPose& sample : samples)
    sample.pose = prf_core::pose_from(motion * sample.pose.isometry());
  return samples;
}

// Weighted sums of poses; the mean is taken at the end.
struct PoseSum {
  void add(const TimedPose& sample, double weight) {
    time += weight * sample.time;
    position += weight * sample.pose.position;
    const Eigen::Vector4d q = sample.pose.orientation.coeffs();
    orientation += orientation.dot(q) < 0.0 ? -weight * q : weight * q;
  }

  // The sum of the weights must be 1.
  TimedPose mean() const {
    if (!(orientation.norm() > 1e-3)) {
      throw std::invalid_argument(
          "combining: the orientations of the demonstrations at " + std::to_string(time) +
          " s are half a turn apart and have no mean, must be alike: leave out the "
          "odd one");
    }
    return {time, {position, Eigen::Quaterniond(orientation).normalized()}};
  }

  double time = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector4d orientation = Eigen::Vector4d::Zero();
};

// Pairs (node of a, node of b), both non-decreasing by at most 1, of least summed squared distance.
std::vector<std::pair<std::size_t, std::size_t>> warping_path(const Samples& a, const Samples& b) {
  const auto n = static_cast<Eigen::Index>(a.size());
  const auto m = static_cast<Eigen::Index>(b.size());
  Eigen::MatrixXd cost =
      Eigen::MatrixXd::Constant(n + 1, m + 1, std::numeric_limits<double>::infinity());
  cost(0, 0) = 0.0;
  for (Eigen::Index i = 1; i <= n; ++i) {
    for (Eigen::Index j = 1; j <= m; ++j) {
      const auto& x = a[static_cast<std::size_t>(i - 1)].pose.position;
      const auto& y = b[static_cast<std::size_t>(j - 1)].pose.position;
      cost(i, j) =
          (x - y).squaredNorm() + std::min({cost(i - 1, j - 1), cost(i - 1, j), cost(i, j - 1)});
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> path;
  for (Eigen::Index i = n, j = m; i > 0;) {
    path.emplace_back(static_cast<std::size_t>(i - 1), static_cast<std::size_t>(j - 1));
    const double diagonal = cost(i - 1, j - 1);
    const double up = cost(i - 1, j);
    const double left = cost(i, j - 1);
    const bool is_diagonal = diagonal <= up && diagonal <= left;
    if (is_diagonal || up <= left) --i;
    if (is_diagonal || left < up) --j;
  }
  std::reverse(path.begin(), path.end());
  return path;
}

// For every node of the reference the mean of the samples that go with it.
Samples warped(const Samples& reference, const Samples& samples) {
  const auto path = warping_path(reference, samples);
  std::vector<int> partners(reference.size(), 0);
  for (const auto& pair : path) ++partners[pair.first];
  std::vector<PoseSum> sums(reference.size());
  for (const auto& [node, partner] : path) sums[node].add(samples[partner], 1.0 / partners[node]);
  Samples result;
  for (const PoseSum& sum : sums) result.push_back(sum.mean());
  return result;
}

}  // namespace

Demonstration combined(const std::vector<Demonstration>& demonstrations, std::size_t nodes,
                       Alignment alignment) {
  if (demonstrations.empty()) throw std::invalid_argument("combining: no demonstrations given");
  const Demonstration& first = demonstrations.front();
  const double weight = 1.0 / static_cast<double>(demonstrations.size());
  std::vector<PoseSum> sums(nodes);
  Samples reference;
  for (const Demonstration& demonstration : demonstrations) {
    if (demonstration.frame() != first.frame() ||
        demonstration.child_frame() != first.child_frame()) {
      throw std::invalid_argument("combining: a demonstration moves '" +
                                  demonstration.child_frame() + "' in '" + demonstration.frame() +
                                  "', must be '" + first.child_frame() + "' in '" + first.frame() +
                                  "' as the first");
    }
    const Eigen::Isometry3d motion =
        first.target().isometry() * demonstration.target().isometry().inverse();
    Samples samples = moved(demonstration.resampled_by_arc_length(nodes), motion);
    if (reference.empty()) reference = samples;
    if (alignment == Alignment::kDynamicTimeWarping) samples = warped(reference, samples);
    for (std::size_t k = 0; k < nodes; ++k) sums[k].add(samples[k], weight);
  }
  Samples mean;
  for (const PoseSum& sum : sums) mean.push_back(sum.mean());
  mean.front().time = 0.0;
  return Demonstration(std::move(mean), first.frame(), first.child_frame(), first.target());
}

}  // namespace elte_planner
