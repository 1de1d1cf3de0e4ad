// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/elte_energy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/require.hpp>
#include <stdexcept>
#include <string>

#include "elte_planner/endpoint_solver.hpp"

namespace elte_planner {
namespace {

using ConstMatrix = Eigen::Ref<const Eigen::MatrixXd>;

double second_difference(const ConstMatrix& y, Eigen::Index k, Eigen::Index j) {
  return (y(k + 2, j) - y(k + 1, j)) - (y(k + 1, j) - y(k, j));
}

// Half the derivative of J by (R y)_k; zero where R has no row.
double bending_force(const ConstMatrix& zeta, const ElteWeights& weights, const ConstMatrix& y,
                     Eigen::Index k, Eigen::Index j) {
  if (k < 0 || k > y.rows() - 3) return 0.0;
  return weights.curvature() * second_difference(y, k, j) - 0.25 * second_difference(zeta, k, j);
}

// Half the derivative of J by (E y)_k without the bending; zero where E has no row.
double tension(const ConstMatrix& zeta, const ElteWeights& weights, const ConstMatrix& y,
               Eigen::Index k, Eigen::Index j) {
  const Eigen::Index last = y.rows() - 2;
  if (k < 0 || k > last) return 0.0;
  const double step = y(k + 1, j) - y(k, j);
  double result = weights.elastic * step;
  if (weights.laplacian == Laplacian::kRowNormalised) {
    const double deviation = step - (zeta(k + 1, j) - zeta(k, j));
    if (k == 0) result += deviation;
    if (k == last) result += deviation;
  }
  return result;
}

// Largest distance of a node from the segment between the first and the last.
double chord_distance(const Eigen::MatrixXd& zeta) {
  const Eigen::RowVectorXd origin = zeta.row(0);
  const Eigen::RowVectorXd chord = zeta.row(zeta.rows() - 1) - origin;
  const double squared_length = chord.squaredNorm();
  double farthest = 0.0;
  for (Eigen::Index k = 1; k + 1 < zeta.rows(); ++k) {
    const Eigen::RowVectorXd offset = zeta.row(k) - origin;
    const double along =
        squared_length > 0.0 ? std::clamp(offset.dot(chord) / squared_length, 0.0, 1.0) : 0.0;
    farthest = std::max(farthest, (offset - along * chord).norm());
  }
  return farthest;
}

}  // namespace

void ElteWeights::validate() const {
  constexpr double kMaxWeight = 1e6;  // the Laplacian's is 1
  prf_core::require_between("w_elastic", elastic, 0.0, kMaxWeight);
  prf_core::require_between("w_bending", bending, 0.0, kMaxWeight);
}

double ElteWeights::decay_nodes() const {
  return elastic > 0.0 ? std::sqrt(curvature() / elastic) : std::numeric_limits<double>::infinity();
}

bool is_within_magnitude(const ConstMatrix& values) {
  return (values.array().abs() <= kMaxMagnitude).all();
}

void validate_demonstration_nodes(const ConstMatrix& zeta) {
  if (zeta.rows() < 3 || zeta.cols() < 1) {
    throw std::invalid_argument("demonstration has " + std::to_string(zeta.rows()) + " nodes x " +
                                std::to_string(zeta.cols()) +
                                " dimensions, must have at least 3 x 1");
  }
  if (!is_within_magnitude(zeta)) {
    throw std::invalid_argument("demonstration has a coordinate that is not finite or above 1e100");
  }
}

double energy(const ConstMatrix& zeta, const ElteWeights& weights, const ConstMatrix& y) {
  const Eigen::Index n = y.rows();
  const auto steps = [n](const ConstMatrix& x) { return x.bottomRows(n - 1) - x.topRows(n - 1); };
  const auto bends = [n](const ConstMatrix& x) {
    const auto middle = x.middleRows(1, n - 2);
    return (x.bottomRows(n - 2) - middle) - (middle - x.topRows(n - 2));
  };
  double sum = 0.25 * (bends(y) - bends(zeta)).squaredNorm() +
               weights.bending * bends(y).squaredNorm() + weights.elastic * steps(y).squaredNorm();
  if (weights.laplacian == Laplacian::kRowNormalised) {
    sum += (steps(y).row(0) - steps(zeta).row(0)).squaredNorm() +
           (steps(y).row(n - 2) - steps(zeta).row(n - 2)).squaredNorm();
  }
  return sum;
}

double half_gradient(const ConstMatrix& zeta, const ElteWeights& weights, const ConstMatrix& y,
                     Eigen::Index node, Eigen::Index dimension) {
  const auto bend = [&](Eigen::Index k) { return bending_force(zeta, weights, y, k, dimension); };
  const auto pull = [&](Eigen::Index k) { return tension(zeta, weights, y, k, dimension); };
  return (bend(node) - bend(node - 1)) - (bend(node - 1) - bend(node - 2)) + pull(node - 1) -
         pull(node);
}

void half_gradient(const ConstMatrix& zeta, const ElteWeights& weights, const ConstMatrix& y,
                   Eigen::Index from, Eigen::MatrixXd& result) {
  const Eigen::Index n = y.rows();
  // Nodes whose neighbourhood is whole take the short way.
  const Eigen::Index begin = std::max<Eigen::Index>(from, 2);
  const Eigen::Index end = std::max(begin, n - 2);
  for (Eigen::Index j = 0; j < y.cols(); ++j) {
    for (Eigen::Index k = from; k < std::min(begin, n); ++k) {
      result(k, j) = half_gradient(zeta, weights, y, k, j);
    }
    if (begin < end) {
      double before = bending_force(zeta, weights, y, begin - 2, j);
      double here = bending_force(zeta, weights, y, begin - 1, j);
      for (Eigen::Index k = begin; k < end; ++k) {
        const double after =
            weights.curvature() * second_difference(y, k, j) - 0.25 * second_difference(zeta, k, j);
        result(k, j) = (after - here) - (here - before) -
                       weights.elastic * ((y(k + 1, j) - y(k, j)) - (y(k, j) - y(k - 1, j)));
        before = here;
        here = after;
      }
    }
    for (Eigen::Index k = end; k < n; ++k) {
      result(k, j) = half_gradient(zeta, weights, y, k, j);
    }
  }
}

// Michelot's algorithm: the threshold rises monotonically until no further coordinate drops out.
void project_on_l1_ball(const Eigen::Ref<const Eigen::VectorXd>& centre, double radius,
                        Eigen::Ref<Eigen::VectorXd, 0, Eigen::InnerStride<>> point) {
  if (radius == 0.0) {
    point = centre;
    return;
  }
  if ((point - centre).lpNorm<1>() <= radius) return;
  double threshold = 0.0;
  for (Eigen::Index count = 0, previous = point.size() + 1;; previous = count) {
    count = 0;
    double sum = 0.0;
    for (Eigen::Index j = 0; j < point.size(); ++j) {
      const double distance = std::abs(point[j] - centre[j]);
      if (distance > threshold) {
        sum += distance;
        ++count;
      }
    }
    if (count == 0 || count >= previous) break;
    threshold = (sum - radius) / static_cast<double>(count);
  }
  for (Eigen::Index j = 0; j < point.size(); ++j) {
    const double offset = point[j] - centre[j];
    point[j] = centre[j] + std::copysign(std::max(std::abs(offset) - threshold, 0.0), offset);
  }
}

double endpoint_kkt_residual(const ConstMatrix& zeta, const ElteWeights& weights,
                             const ConstMatrix& y, Eigen::Index frozen,
                             const Eigen::Ref<const Eigen::VectorXd>& goal, double radius) {
  const Eigen::Index last = y.rows() - 1;
  double residual = 0.0;
  for (Eigen::Index j = 0; j < y.cols(); ++j) {
    for (Eigen::Index k = frozen; k < last; ++k) {
      residual = std::max(residual, std::abs(half_gradient(zeta, weights, y, k, j)));
    }
  }
  if (frozen > last) return residual;
  Eigen::VectorXd stepped(y.cols());
  for (Eigen::Index j = 0; j < y.cols(); ++j) {
    stepped[j] = y(last, j) - half_gradient(zeta, weights, y, last, j);
  }
  project_on_l1_ball(goal, radius, stepped);
  return std::max(residual, (y.row(last).transpose() - stepped).cwiseAbs().maxCoeff());
}

double shape_loss(const Eigen::MatrixXd& zeta, const ElteWeights& weights) {
  const double extent = chord_distance(zeta);
  const double size = (zeta.rowwise() - zeta.row(0)).rowwise().norm().maxCoeff();
  if (extent <= 1e-6 * size) return 0.0;
  Eigen::MatrixXd plan = zeta;
  EndpointSolver(zeta, weights).solve(2, zeta.row(zeta.rows() - 1).transpose(), 0.0, plan);
  return (plan - zeta).rowwise().norm().maxCoeff() / extent;
}

}  // namespace elte_planner
