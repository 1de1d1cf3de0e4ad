// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/confidence_radius.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>
#include <string>

namespace elte_planner {
namespace {

// Columns are unit vectors spread evenly over half the sphere; the norm is even, so half is enough.
Eigen::MatrixXd even_directions(Eigen::Index dimensions) {
  if (dimensions == 1) return Eigen::MatrixXd::Ones(1, 1);
  constexpr Eigen::Index kCount = 512;
  Eigen::MatrixXd directions(dimensions, kCount);
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  for (Eigen::Index i = 0; i < kCount; ++i) {
    const double fraction = (static_cast<double>(i) + 0.5) / static_cast<double>(kCount);
    if (dimensions == 2) {
      directions.col(i) << std::cos(M_PI * fraction), std::sin(M_PI * fraction);
    } else {
      const double longitude = golden_angle * static_cast<double>(i);
      const double ring = std::sqrt(1.0 - fraction * fraction);
      directions.col(i) << ring * std::cos(longitude), ring * std::sin(longitude), fraction;
    }
  }
  return directions;
}

const Eigen::MatrixXd& cached_directions(Eigen::Index dimensions) {
  static const Eigen::MatrixXd directions[] = {even_directions(1), even_directions(2),
                                               even_directions(3)};
  return directions[dimensions - 1];
}

// P(chi_d <= x) for d <= 3, which is prf_core::chi_square_cdf(d, x^2) in closed form: it takes a
// twentieth of Boost's time, and one plan needs it about a hundred thousand times.
double chi_distribution(Eigen::Index dimensions, double x) {
  if (dimensions == 2) return -std::expm1(-0.5 * x * x);
  const double half_normal = std::erf(x * M_SQRT1_2);
  if (dimensions == 1) return half_normal;
  return half_normal - std::sqrt(M_2_PI) * x * std::exp(-0.5 * x * x);
}

// S with S S' = covariance.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& covariance) {
  const double scale = covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-6 * scale) {
    throw std::invalid_argument("covariance is not symmetric");
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const double smallest = eigen.eigenvalues().minCoeff();
  if (smallest < -1e-6 * scale) {
    throw std::invalid_argument("covariance has the eigenvalue " + std::to_string(smallest) +
                                ", must be at least 0");
  }
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

double confidence_radius(const Eigen::Ref<const Eigen::MatrixXd>& covariance, double probability) {
  const Eigen::Index d = covariance.rows();
  if (d < 1 || d > 3 || covariance.cols() != d) {
    throw std::invalid_argument("covariance is " + std::to_string(d) + " x " +
                                std::to_string(covariance.cols()) +
                                ", must be square with 1 to 3 rows");
  }
  if (!covariance.allFinite()) throw std::invalid_argument("covariance is not finite");
  if (!(probability > 0.0 && probability < 1.0)) {
    throw std::invalid_argument("probability is " + std::to_string(probability) +
                                ", must be within (0, 1)");
  }
  const Eigen::VectorXd norms =
      (square_root(covariance) * cached_directions(d)).cwiseAbs().colwise().sum().transpose();
  const double longest = norms.maxCoeff();
  if (longest == 0.0) return 0.0;

  const auto probability_within = [&](double radius) {
    double sum = 0.0;
    for (const double norm : norms) {
      sum += norm > 0.0 ? chi_distribution(d, radius / norm) : 1.0;
    }
    return sum / static_cast<double>(norms.size());
  };
  double low = 0.0;
  double high = longest;
  while (probability_within(high) < probability) {
    low = high;
    high *= 2.0;
    if (high > 64.0 * longest) return high;  // the probability is 1 to the last digit
  }
  while (high - low > 1e-4 * high) {
    const double middle = 0.5 * (low + high);
    (probability_within(middle) < probability ? low : high) = middle;
  }
  return high;
}

}  // namespace elte_planner
