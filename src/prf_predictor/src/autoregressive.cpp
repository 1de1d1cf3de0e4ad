// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include <prf_core/require.hpp>
#include "prf_predictor/window_predictor.hpp"

namespace prf_predictor {

using prf_core::require;
namespace {

constexpr double kPeriod = 1.0 / 15;  // s
constexpr double kLongest = 3.0;      // s that are iterated ahead
constexpr double kRidge = 1e-4;       // of the regressors' mean square
constexpr double kFarthest = 2.0;  // half ranges of the window that a forecast may leave its mean

// Positions at equal intervals, the first at `start`; stands still after the last.
class Path : public Continuation {
 public:
  Path(double start, Eigen::Matrix3Xd positions)
      : start_(start), positions_(std::move(positions)) {}

  [[nodiscard]] Eigen::Vector3d position(double time) const override {
    const auto last = static_cast<double>(positions_.cols() - 1);
    const double at = std::clamp((time - start_) / kPeriod, 0.0, last);
    const auto lower = static_cast<Eigen::Index>(at);
    const Eigen::Index upper = std::min(lower + 1, positions_.cols() - 1);
    const double fraction = at - static_cast<double>(lower);
    return positions_.col(lower) + fraction * (positions_.col(upper) - positions_.col(lower));
  }

 private:
  double start_;
  Eigen::Matrix3Xd positions_;
};

// The samples on the grid that ends with the last one, by linear interpolation.
Eigen::MatrixX3d on_grid(const std::deque<Sample>& samples) {
  const double end = samples.back().time;
  const auto rows = static_cast<Eigen::Index>((end - samples.front().time) / kPeriod + 1e-9) + 1;
  Eigen::MatrixX3d grid(rows, 3);
  std::size_t next = 0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double t = end - static_cast<double>(rows - 1 - row) * kPeriod;
    while (next + 1 < samples.size() && samples[next].time < t) ++next;
    const Sample& after = samples[next];
    const Sample& before = samples[next > 0 ? next - 1 : 0];
    const double width = after.time - before.time;
    const double fraction = width > 0 ? std::clamp((t - before.time) / width, 0.0, 1.0) : 1.0;
    grid.row(row) = before.position + fraction * (after.position - before.position);
  }
  return grid;
}

// A^T A and A^T x of x_k = sum over lags 1 .. order of a_lag x_{k - lag}, for all k that have so
// many before them. Down a diagonal of A^T A each sum has one product more and one less than the
// last.
Eigen::MatrixXd normal_equations(const Eigen::VectorXd& x, Eigen::Index order,
                                 Eigen::VectorXd& right) {
  const Eigen::Index equations = x.size() - order;
  Eigen::MatrixXd normal(order, order);
  const auto lagged = [&](Eigen::Index lag) { return x.segment(order - lag, equations); };
  for (Eigen::Index j = 0; j < order; ++j) {
    right(j) = lagged(j + 1).dot(lagged(0));
    normal(j, 0) = lagged(j + 1).dot(lagged(1));
  }
  for (Eigen::Index i = 1; i < order; ++i) {
    for (Eigen::Index j = i; j < order; ++j) {
      const Eigen::Index a = order - 1 - i;
      const Eigen::Index b = order - 1 - j;
      normal(j, i) = normal(j - 1, i - 1) + x(a) * x(b) - x(a + equations) * x(b + equations);
    }
  }
  normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
  return normal;
}

// x, of the last rows, continued by `steps` values.
Eigen::VectorXd continued(const Eigen::VectorXd& x, Eigen::Index order, Eigen::Index steps) {
  const double mean = x.mean();
  const double range = kFarthest * 0.5 * (x.maxCoeff() - x.minCoeff());
  const Eigen::VectorXd centred = x.array() - mean;
  Eigen::VectorXd right(order);
  Eigen::MatrixXd normal = normal_equations(centred, order, right);
  normal.diagonal().array() += kRidge * centred.squaredNorm() + 1e-12;
  const Eigen::VectorXd a = normal.ldlt().solve(right);
  Eigen::VectorXd path(order + steps);
  path.head(order) = centred.tail(order);
  for (Eigen::Index k = order; k < path.size(); ++k) {
    path(k) = std::clamp(a.dot(path.segment(k - order, order).reverse()), -range, range);
  }
  return path.tail(steps).array() + mean;
}

}  // namespace

Autoregressive::Autoregressive(double window, double order)
    : window_(window), order_(static_cast<int>(order)) {
  require(window >= 0.1 && window <= 60, "window", window, "0.1 .. 60 s");
  require(order >= 1 && order <= 60 && order == std::floor(order), "order", order,
          "a whole number 1 .. 60");
}

std::shared_ptr<const Continuation> Autoregressive::fit(const std::deque<Sample>& samples) const {
  const Eigen::MatrixX3d grid = on_grid(samples);
  if (grid.rows() < 2 * order_) return Hold().fit(samples);
  const auto steps = static_cast<Eigen::Index>(kLongest / kPeriod);
  Eigen::Matrix3Xd path(3, steps + 1);
  path.col(0) = samples.back().position;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    path.row(axis).tail(steps) = continued(grid.col(axis), order_, steps);
  }
  return std::make_shared<Path>(samples.back().time, path);
}

}  // namespace prf_predictor
