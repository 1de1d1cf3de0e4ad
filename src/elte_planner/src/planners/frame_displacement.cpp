// SPDX-License-Identifier: BSD-3-Clause
#include "frame_displacement.hpp"

#include <vector>

namespace elte_planner {

Eigen::MatrixXd frame_displacement(const PlanRequest& request,
                                   const Eigen::MatrixXd& demonstration) {
  using Index = Eigen::Index;
  const Index nodes = demonstration.rows();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(nodes, demonstration.cols());
  if (request.approach.empty()) return result;
  std::vector<bool> known(static_cast<std::size_t>(nodes), false);
  const auto set = [&](Index node, const Eigen::VectorXd& centre) {
    result.row(node) = centre.transpose() - demonstration.row(node);
    known[static_cast<std::size_t>(node)] = true;
  };
  for (const NodeBall& ball : request.approach) set(ball.node, ball.centre);
  set(nodes - 1, request.goal);

  Index before = 0;  // the latest known node, at first the start of the ramp
  for (Index k = request.frozen; k < nodes; ++k) {
    if (!known[static_cast<std::size_t>(k)]) continue;
    for (Index i = before + 1; i < k; ++i) {
      const double share = static_cast<double>(i - before) / static_cast<double>(k - before);
      result.row(i) = (1.0 - share) * result.row(before) + share * result.row(k);
    }
    before = k;
  }
  const Index first = request.frozen;
  if (known[static_cast<std::size_t>(first)] && first + 1 < nodes) {
    const Eigen::RowVectorXd step = result.row(first + 1) - result.row(first);
    result.topRows(first - 1).setZero();
    result.row(first - 1) = result.row(first) - step;
    result.row(first - 2) = result.row(first) - 2.0 * step;
  }
  return result;
}

}  // namespace elte_planner
