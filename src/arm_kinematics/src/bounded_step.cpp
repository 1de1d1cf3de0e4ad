// SPDX-License-Identifier: BSD-3-Clause
#include "bounded_step.hpp"

#include <Eigen/Cholesky>
#include <array>

namespace arm_kinematics {
namespace {

// Makes x[i] known: its share goes to the right-hand side, its row becomes x[i] = value.
void fix(Eigen::Index i, double value, JointMatrix* h, JointVector* g) {
  *g -= h->col(i) * value;
  h->col(i).setZero();
  h->row(i).setZero();
  (*h)(i, i) = 1.0;
  (*g)[i] = value;
}

}  // namespace

std::optional<JointVector> bounded_step(const JointMatrix& h, const JointVector& g,
                                        const JointVector& lower, const JointVector& upper) {
  JointMatrix left = h;
  JointVector right = g;
  std::array<bool, kMaxJoints> fixed{};
  const Eigen::Index n = g.size();
  // A joint on its bound that is pushed outward is fixed from the start.
  for (Eigen::Index i = 0; i < n; ++i) {
    if ((g[i] > 0.0 && upper[i] <= 0.0) || (g[i] < 0.0 && lower[i] >= 0.0)) {
      fix(i, 0.0, &left, &right);
      fixed[static_cast<std::size_t>(i)] = true;
    }
  }
  JointVector x;
  for (Eigen::Index round = 0; round <= n; ++round) {
    const Eigen::LLT<JointMatrix> factor(left);
    if (factor.info() != Eigen::Success) return std::nullopt;
    x = factor.solve(right);
    if (!x.allFinite()) return std::nullopt;
    bool all_inside = true;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (fixed[static_cast<std::size_t>(i)] || (x[i] >= lower[i] && x[i] <= upper[i])) continue;
      fix(i, x[i] < lower[i] ? lower[i] : upper[i], &left, &right);
      fixed[static_cast<std::size_t>(i)] = true;
      all_inside = false;
    }
    if (all_inside) break;
  }
  x = x.cwiseMax(lower).cwiseMin(upper);
  return x;
}

}  // namespace arm_kinematics
