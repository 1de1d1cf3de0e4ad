// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include <prf_core/require.hpp>
#include "prf_predictor/window_predictor.hpp"

namespace prf_predictor {

using prf_core::require;
namespace {

constexpr double kFastest = 12.0;    // rad/s
constexpr double kTurns = 0.6;       // of the slowest sine within the window
constexpr double kShortest = 2.0;    // s of samples that a fit needs
constexpr double kOversampling = 4;  // of the periodogram
constexpr int kRefinements = 3;
constexpr double kRidge = 1e-6;

// Columns 1, cos(W_k t), sin(W_k t).
Eigen::MatrixXd regressors(const Eigen::VectorXd& t, const std::vector<double>& frequencies) {
  Eigen::MatrixXd A(t.size(), 1 + 2 * static_cast<Eigen::Index>(frequencies.size()));
  A.col(0).setOnes();
  Eigen::Index column = 1;
  for (const double W : frequencies) {
    A.col(column++) = (W * t).array().cos();
    A.col(column++) = (W * t).array().sin();
  }
  return A;
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& y) {
  Eigen::MatrixXd normal = A.transpose() * A;
  normal.diagonal().array() += kRidge * static_cast<double>(A.rows());
  return normal.ldlt().solve(A.transpose() * y);
}

// Windowed cosines and sines of a grid of frequencies, over one window's samples.
class Periodogram {
 public:
  explicit Periodogram(const Eigen::VectorXd& t) {
    const double resolution = 2 * M_PI / -t(0);  // t runs from t(0) to 0
    step_ = resolution / kOversampling;
    first_ = kTurns * resolution;
    const auto count = static_cast<Eigen::Index>((kFastest - first_) / step_) + 1;
    cosines_.resize(count, t.size());
    sines_.resize(count, t.size());
    const Eigen::ArrayXd window = 1 - (2 * t.array() / t(0) - 1).square();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::ArrayXd phase = (first_ + static_cast<double>(i) * step_) * t.array();
      cosines_.row(i) = window * phase.cos();
      sines_.row(i) = window * phase.sin();
    }
  }

  [[nodiscard]] double strongest_frequency(const Eigen::MatrixX3d& y) const {
    const Eigen::VectorXd power =
        (cosines_ * y).rowwise().squaredNorm() + (sines_ * y).rowwise().squaredNorm();
    Eigen::Index best = 0;
    power.maxCoeff(&best);
    double offset = 0.0;  // of the vertex of the parabola through the peak and its neighbours
    if (best > 0 && best + 1 < power.size()) {
      const double curvature = power(best - 1) - 2 * power(best) + power(best + 1);
      if (curvature < 0) offset = 0.5 * (power(best - 1) - power(best + 1)) / curvature;
    }
    return first_ + (static_cast<double>(best) + offset) * step_;
  }

 private:
  double first_ = 0.0;
  double step_ = 0.0;
  Eigen::MatrixXd cosines_;
  Eigen::MatrixXd sines_;
};

// Gauss-Newton steps on amplitudes and frequencies together.
void refine(const Eigen::VectorXd& t, const Eigen::MatrixX3d& y, std::vector<double>& frequencies) {
  const double farthest = 0.5 * M_PI / -t(0);
  for (int iteration = 0; iteration < kRefinements; ++iteration) {
    const Eigen::MatrixXd A = regressors(t, frequencies);
    const Eigen::MatrixXd amplitudes = least_squares(A, y);
    const Eigen::MatrixXd residual = y - A * amplitudes;
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      const auto column = 1 + 2 * static_cast<Eigen::Index>(k);
      const Eigen::MatrixXd slope = t.asDiagonal() * (A.col(column) * amplitudes.row(column + 1) -
                                                      A.col(column + 1) * amplitudes.row(column));
      const double step = slope.cwiseProduct(residual).sum() / (slope.squaredNorm() + 1e-12);
      frequencies[k] = std::max(0.1, frequencies[k] + std::clamp(step, -farthest, farthest));
    }
  }
}

class Superposition : public Continuation {
 public:
  Superposition(double now, std::vector<double> frequencies, Eigen::MatrixXd amplitudes)
      : now_(now), frequencies_(std::move(frequencies)), amplitudes_(std::move(amplitudes)) {}

  [[nodiscard]] Eigen::Vector3d position(double time) const override {
    const Eigen::VectorXd t = Eigen::VectorXd::Constant(1, time - now_);
    return (regressors(t, frequencies_) * amplitudes_).transpose();
  }

 private:
  double now_;
  std::vector<double> frequencies_;
  Eigen::MatrixXd amplitudes_;
};

}  // namespace

Sines::Sines(double window, double count) : window_(window), count_(static_cast<int>(count)) {
  require(window > kShortest && window <= 60, "window", window, "> 2 and <= 60 s");
  require(count >= 1 && count <= 8 && count == std::floor(count), "count", count,
          "a whole number 1 .. 8");
}

std::shared_ptr<const Continuation> Sines::fit(const std::deque<Sample>& samples,
                                               const Continuation* before) const {
  const double now = samples.back().time;
  if (now - samples.front().time < kShortest) return Hold().fit(samples, before);
  const auto rows = static_cast<Eigen::Index>(samples.size());
  Eigen::VectorXd t(rows);
  Eigen::MatrixX3d y(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Sample& sample = samples[static_cast<std::size_t>(i)];
    t(i) = sample.time - now;
    y.row(i) = sample.position;
  }
  const auto affordable = static_cast<int>((now - samples.front().time) / kShortest);
  const Periodogram periodogram(t);
  std::vector<double> frequencies;
  Eigen::MatrixX3d residual = y.rowwise() - y.colwise().mean();
  for (int k = 0; k < std::min(count_, affordable); ++k) {
    frequencies.push_back(periodogram.strongest_frequency(residual));
    refine(t, y, frequencies);
    const Eigen::MatrixXd A = regressors(t, frequencies);
    residual = y - A * least_squares(A, y);
  }
  const Eigen::MatrixXd A = regressors(t, frequencies);
  return std::make_shared<Superposition>(now, frequencies, least_squares(A, y));
}

}  // namespace prf_predictor
