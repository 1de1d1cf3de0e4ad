// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>

#include "prf_core/require.hpp"

namespace prf_core {

double chi_square_quantile(int degrees, double probability) {
  require(degrees >= 1, "degrees", degrees, ">= 1");
  require(probability > 0.0 && probability < 1.0, "probability", probability, "within (0, 1)");
  return boost::math::quantile(boost::math::chi_squared(degrees), probability);
}

double chi_square_cdf(int degrees, double x) {
  require(degrees >= 1, "degrees", degrees, ">= 1");
  require(x >= 0.0, "x", x, ">= 0");
  return boost::math::cdf(boost::math::chi_squared(degrees), x);
}

}  // namespace prf_core
