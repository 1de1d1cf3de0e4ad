// SPDX-License-Identifier: BSD-3-Clause
//
// Radius of the smallest l1 ball around the mean of a normal distribution that holds a given
// probability: the r with P(|x|_1 <= r) = probability, x ~ N(0, covariance).
//
// With x = rho S u, covariance = S S', u uniform on the unit sphere and rho chi-distributed,
// P = mean over u of F_chi(r / |S u|_1); the mean is taken over a fixed, uniformly spread set of
// directions, which leaves a relative error of r below 0.5 %.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace elte_planner {

struct NormRule;

// For one probability and number of dimensions; does not allocate.
class ConfidenceRadius {
 public:
  // dimensions: 1 to 3. probability in (0, 1). Throws std::invalid_argument otherwise.
  ConfidenceRadius(Eigen::Index dimensions, double probability);

  // covariance: symmetric positive semidefinite, m^2; throws std::invalid_argument otherwise. The
  // radius is 0 for a zero covariance. At or above `enough` it need not be found: then the result
  // is some value from `enough` up to the radius.
  double operator()(const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                    double enough = std::numeric_limits<double>::infinity()) const;

 private:
  double solve_for_radius(const NormRule& rule, double enough) const;

  Eigen::Index dimensions_;
  double probability_;
  double chi_quantile_;
};

[[nodiscard]] double confidence_radius(const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                       double probability);

}  // namespace elte_planner
