// SPDX-License-Identifier: BSD-3-Clause
// The chi-square distribution, from Boost.Math behind a plain header: gates and confidence regions.
#pragma once

namespace prf_core {

// x with P(chi^2_degrees <= x) = probability; degrees >= 1, probability in (0, 1), else
// std::invalid_argument.
[[nodiscard]] double chi_square_quantile(int degrees, double probability);

// P(chi^2_degrees <= x) for x >= 0, degrees >= 1, else std::invalid_argument.
[[nodiscard]] double chi_square_cdf(int degrees, double x);

}  // namespace prf_core
