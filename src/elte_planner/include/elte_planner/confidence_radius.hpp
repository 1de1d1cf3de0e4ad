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

namespace elte_planner {

// covariance: symmetric positive semidefinite, 1 to 3 dimensions, m^2. probability in (0, 1).
// Throws std::invalid_argument otherwise. The radius is 0 for a zero covariance.
[[nodiscard]] double confidence_radius(const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                       double probability);

}  // namespace elte_planner
