// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
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

constexpr int kMostLags = 60;
using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostLags, kMostLags>;
using Lags = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostLags, 1>;

// a of each axis, the longest lag first, so that they meet the path in the order of time.
using Coefficients = std::array<Lags, 3>;

// Positions at equal intervals, the first at `start`; stands still after the last.
class Path : public Continuation {
 public:
  Path(double start, Eigen::Matrix3Xd positions, Coefficients coefficients, int newest)
      : start_(start),
        positions_(std::move(positions)),
        coefficients_(std::move(coefficients)),
        newest_(newest) {}

  [[nodiscard]] Eigen::Vector3d position(double time) const override {
    const auto last = static_cast<double>(positions_.cols() - 1);
    const double at = std::clamp((time - start_) / kPeriod, 0.0, last);
    const auto lower = static_cast<Eigen::Index>(at);
    const Eigen::Index upper = std::min(lower + 1, positions_.cols() - 1);
    const double fraction = at - static_cast<double>(lower);
    return positions_.col(lower) + fraction * (positions_.col(upper) - positions_.col(lower));
  }

  [[nodiscard]] const Lags& coefficients(int axis) const {
    return coefficients_[static_cast<std::size_t>(axis)];
  }
  // The axis whose coefficients are the newest.
  [[nodiscard]] int newest() const { return newest_; }

 private:
  double start_;
  Eigen::Matrix3Xd positions_;
  Coefficients coefficients_;
  int newest_;
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

// A^T A (its lower half) and A^T x of x_k = sum over lags 1 .. order of a_lag x_{k - lag}, for all
// k that have so many before them. With s(i, j) the product of x delayed by order - i with x
// delayed by order - j, A^T A is s for i, j < order and A^T x is s(order, j); down a diagonal each
// s has one product more and one less than the last.
Normal normal_equations(const Eigen::VectorXd& x, Eigen::Index order, Lags& right) {
  const Eigen::Index equations = x.size() - order;
  Normal normal(order, order);
  for (Eigen::Index lag = 0; lag <= order; ++lag) {
    double sum = x.segment(lag, equations).dot(x.head(equations));
    for (Eigen::Index j = 0; j < order - lag; ++j) {
      normal(j + lag, j) = sum;
      sum += x(j + lag + equations) * x(j + equations) - x(j + lag) * x(j);
    }
    if (lag > 0) right(order - lag) = sum;
  }
  return normal;
}

Lags fitted(const Eigen::VectorXd& x, Eigen::Index order) {
  Lags a(order);
  Normal normal = normal_equations(x, order, a);
  normal.diagonal().array() += kRidge * x.squaredNorm() + 1e-12;
  const Eigen::LLT<Eigen::Ref<Normal>> factors(normal);  // in place
  factors.solveInPlace(a);
  return a;
}

// `steps` values after those of x.
Eigen::VectorXd continued(const Eigen::VectorXd& x, const Lags& a, Eigen::Index steps) {
  const double range = kFarthest * 0.5 * (x.maxCoeff() - x.minCoeff());
  const Eigen::Index order = a.size();
  Eigen::VectorXd path(order + steps);
  path.head(order) = x.tail(order);
  for (Eigen::Index k = order; k < path.size(); ++k) {
    path(k) = std::clamp(a.dot(path.segment(k - order, order)), -range, range);
  }
  return path.tail(steps);
}

}  // namespace

Autoregressive::Autoregressive(double window, double order)
    : window_(window), order_(static_cast<int>(order)) {
  require(window >= 0.1 && window <= 60, "window", window, "0.1 .. 60 s");
  require(order >= 1 && order <= kMostLags && order == std::floor(order), "order", order,
          "a whole number 1 .. 60");
}

std::shared_ptr<const Continuation> Autoregressive::fit(const std::deque<Sample>& samples,
                                                        const Continuation* before) const {
  const Eigen::MatrixX3d grid = on_grid(samples);
  if (grid.rows() < 2 * order_) return Hold().fit(samples, nullptr);
  const auto* const known = dynamic_cast<const Path*>(before);  // null: the window was too short
  const int anew = known != nullptr ? (known->newest() + 1) % 3 : 0;
  Coefficients coefficients;
  const auto steps = static_cast<Eigen::Index>(kLongest / kPeriod);
  Eigen::Matrix3Xd path(3, steps + 1);
  path.col(0) = samples.back().position;
  for (int axis = 0; axis < 3; ++axis) {
    const double mean = grid.col(axis).mean();
    const Eigen::VectorXd centred = grid.col(axis).array() - mean;
    Lags& a = coefficients[static_cast<std::size_t>(axis)];
    a = known != nullptr && axis != anew ? known->coefficients(axis) : fitted(centred, order_);
    path.row(axis).tail(steps) = continued(centred, a, steps).array() + mean;
  }
  return std::make_shared<Path>(samples.back().time, std::move(path), coefficients, anew);
}

}  // namespace prf_predictor
