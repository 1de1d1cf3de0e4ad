// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/confidence_radius.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <prf_core/require.hpp>
#include <stdexcept>
#include <string>

#include "direction_norms.hpp"

namespace elte_planner {
namespace {

using Triangle = std::array<double, 6>;  // s00 s10 s11 s20 s21 s22

// Unit vectors spread evenly over half the sphere; the norm is even, so half is enough.
Directions even_directions(Eigen::Index dimensions) {
  Directions directions{};
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double fraction = (static_cast<double>(i) + 0.5) / kDirections;
    const double longitude =
        dimensions == 3 ? golden_angle * static_cast<double>(i) : M_PI * fraction;
    const double height = dimensions == 3 ? fraction : 0.0;
    const double ring = std::sqrt(1.0 - height * height);
    directions.x[i] = dimensions == 1 ? 1.0 : ring * std::cos(longitude);
    directions.y[i] = dimensions == 1 ? 0.0 : ring * std::sin(longitude);
    directions.z[i] = height;
  }
  return directions;
}

const Directions& cached_directions(Eigen::Index dimensions) {
  static const Directions directions[] = {even_directions(1), even_directions(2),
                                          even_directions(3)};
  return directions[dimensions - 1];
}

struct Probability {
  double value, density;
};

// P(chi_d <= x) for d <= 3 and its derivative.
Probability chi_distribution(Eigen::Index dimensions, double x) {
  const double bell = std::exp(-0.5 * x * x);
  if (dimensions == 2) return {-std::expm1(-0.5 * x * x), x * bell};
  const double half_normal = std::erf(x * M_SQRT1_2);
  const double density = std::sqrt(M_2_PI) * bell;
  if (dimensions == 1) return {half_normal, density};
  return {half_normal - x * density, x * x * density};
}

double chi_quantile(Eigen::Index dimensions, double probability) {
  double low = 0.0;
  double high = 40.0;  // beyond it the probability is 1 to the last digit
  while (true) {
    const double middle = 0.5 * (low + high);
    if (!(low < middle && middle < high)) return high;
    (chi_distribution(dimensions, middle).value < probability ? low : high) = middle;
  }
}

// Cholesky's factor, or nothing for a matrix that is not clearly positive definite.
std::optional<Triangle> cholesky(const Eigen::Matrix3d& c, double scale) {
  const double least = 1e-9 * scale;  // pivots below it have lost half their digits
  if (!(c(0, 0) > least)) return std::nullopt;
  Triangle s{};
  s[0] = std::sqrt(c(0, 0));
  s[1] = c(1, 0) / s[0];
  s[3] = c(2, 0) / s[0];
  const double second = c(1, 1) - s[1] * s[1];
  if (!(second > least)) return std::nullopt;
  s[2] = std::sqrt(second);
  s[4] = (c(2, 1) - s[3] * s[1]) / s[2];
  const double third = c(2, 2) - s[3] * s[3] - s[4] * s[4];
  if (!(third > least)) return std::nullopt;
  s[5] = std::sqrt(third);
  return s;
}

// The same for a singular matrix, and the refusal of an indefinite one. From covariance = V D V',
// the factor R' of sqrt(D) V' = Q R.
Triangle semidefinite_root(const Eigen::Matrix3d& covariance, double scale) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  const double smallest = eigen.eigenvalues().minCoeff();
  if (smallest < -1e-6 * scale) {
    throw std::invalid_argument("covariance has the eigenvalue " + std::to_string(smallest) +
                                ", must be at least 0");
  }
  // Rows of sqrt(D) V', made triangular by Gram and Schmidt on the columns.
  Eigen::Matrix3d columns =
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
  Eigen::Matrix3d lower = Eigen::Matrix3d::Zero();
  for (Eigen::Index a = 0; a < 3; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      lower(a, b) = columns.col(b).dot(columns.col(a));
      columns.col(a) -= lower(a, b) * columns.col(b);
    }
    lower(a, a) = columns.col(a).norm();
    if (lower(a, a) > 0.0) columns.col(a) /= lower(a, a);
  }
  return {lower(0, 0), lower(1, 0), lower(1, 1), lower(2, 0), lower(2, 1), lower(2, 2)};
}

// A lower bound of the least singular value, by Frobenius' norm of the inverse.
double least_stretch(const Triangle& s) {
  const double a = 1.0 / s[0], b = 1.0 / s[2], c = 1.0 / s[5];
  const double ab = s[1] * a * b, bc = s[4] * b * c, ac = (s[1] * s[4] * b - s[3]) * a * c;
  return 1.0 / std::sqrt(a * a + b * b + c * c + ab * ab + bc * bc + ac * ac);
}

}  // namespace

ConfidenceRadius::ConfidenceRadius(Eigen::Index dimensions, double probability)
    : dimensions_(dimensions), probability_(probability), chi_quantile_(0.0) {
  prf_core::require_between("dimensions", static_cast<double>(dimensions), 1.0, 3.0);
  prf_core::require(probability > 0.0 && probability < 1.0, "probability", probability,
                    "within (0, 1)");
  chi_quantile_ = chi_quantile(dimensions, probability);
}

double ConfidenceRadius::operator()(const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                    double enough) const {
  const Eigen::Index d = dimensions_;
  if (covariance.rows() != d || covariance.cols() != d) {
    throw std::invalid_argument("covariance is " + std::to_string(covariance.rows()) + " x " +
                                std::to_string(covariance.cols()) + ", must be " +
                                std::to_string(d) + " x " + std::to_string(d));
  }
  if (!covariance.allFinite()) {
    throw std::invalid_argument("covariance has a value that is not finite, must be finite");
  }
  const double scale = covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-6 * scale) {
    throw std::invalid_argument("covariance differs from its transpose, must be symmetric");
  }
  // Missing dimensions have a variance, but no directions.
  Eigen::Matrix3d padded = scale * Eigen::Matrix3d::Identity();
  padded.topLeftCorner(d, d) = covariance;
  if (scale == 0.0) return 0.0;
  std::optional<Triangle> root = cholesky(padded, scale);
  if (!root) root = semidefinite_root(padded, scale);

  // |S u|_1 >= |S u| >= 1 / |S^-1|: far above `enough` no mean is needed.
  if (chi_quantile_ * least_stretch(*root) >= enough) return enough;
  NormRule rule;
  norm_rule(cached_directions(d), *root, rule);
  return solve_for_radius(rule, enough);
}

// Newton's method; the root lies between those for the least and the greatest norm alone.
double ConfidenceRadius::solve_for_radius(const NormRule& rule, double enough) const {
  double low = chi_quantile_ * rule.least;
  double high = chi_quantile_ * rule.greatest;
  if (low >= enough || !(low < high)) return low;
  double radius = 0.0;
  for (std::size_t j = 0; j < kNormNodes; ++j) {
    radius += chi_quantile_ * rule.weight[j] * rule.norm[j];
  }
  radius = std::clamp(radius, low, high);
  constexpr int kMaxSteps = 50;
  for (int step = 0; step < kMaxSteps; ++step) {
    double missing = probability_;
    double slope = 0.0;
    for (std::size_t j = 0; j < kNormNodes; ++j) {
      const Probability within = chi_distribution(dimensions_, radius / rule.norm[j]);
      missing -= rule.weight[j] * within.value;
      slope += rule.weight[j] * within.density / rule.norm[j];
    }
    (missing > 0.0 ? low : high) = radius;
    const double newton = radius + missing / slope;
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    // A step of Newton's method squares the relative error.
    if (std::abs(next - radius) <= 1e-5 * radius) return next;
    radius = next;
  }
  return radius;
}

double confidence_radius(const Eigen::Ref<const Eigen::MatrixXd>& covariance, double probability) {
  return ConfidenceRadius(covariance.rows(), probability)(covariance);
}

}  // namespace elte_planner
