// SPDX-License-Identifier: BSD-3-Clause
// The chi-square distribution, from Boost.Math behind a plain header: gates and confidence regions.
#pragma once

namespace prf_core {

// x with P(X <= x) = probability, where X is chi-square with `degrees` degrees of freedom. Throws
// std::invalid_argument unless degrees >= 1 and probability is in (0, 1).
[[nodiscard]] double chi_square_quantile(int degrees, double probability);

// P(X <= x) of the same X. Throws std::invalid_argument unless degrees >= 1 and x >= 0.
[[nodiscard]] double chi_square_cdf(int degrees, double x);

}  // namespace prf_core
