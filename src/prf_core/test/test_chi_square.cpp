// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/chi_square.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace prf_core {
namespace {

// Abramowitz, Stegun, Handbook of Mathematical Functions, table 26.8.
TEST(ChiSquare, HasTheQuantilesOfTheTable) {
  struct Row {
    int degrees;
    double probability;
    double quantile;
  };
  for (const Row& row : {Row{1, 0.95, 3.84146}, Row{1, 0.99, 6.63490}, Row{2, 0.95, 5.99147},
                         Row{3, 0.95, 7.81473}, Row{3, 0.99, 11.3449}, Row{3, 0.999, 16.2662},
                         Row{6, 0.95, 12.5916}, Row{10, 0.05, 3.94030}, Row{100, 0.5, 99.3341}}) {
    EXPECT_NEAR(chi_square_quantile(row.degrees, row.probability), row.quantile,
                1e-5 * row.quantile)
        << row.degrees << " " << row.probability;
    EXPECT_NEAR(chi_square_cdf(row.degrees, row.quantile), row.probability, 1e-5);
  }
}

TEST(ChiSquare, OfTwoDegreesIsExponential) {
  for (const double x : {0.0, 1e-6, 0.5, 3.0, 40.0}) {
    EXPECT_NEAR(chi_square_cdf(2, x), -std::expm1(-x / 2), 1e-15) << x;
  }
}

TEST(ChiSquare, QuantileInvertsTheDistribution) {
  for (const int degrees : {1, 2, 3, 6, 50}) {
    for (double probability = 0.001; probability < 1.0; probability += 0.037) {
      EXPECT_NEAR(chi_square_cdf(degrees, chi_square_quantile(degrees, probability)), probability,
                  1e-12);
    }
  }
}

TEST(ChiSquare, RefusesWhatHasNoValue) {
  for (const double probability : {0.0, 1.0, -0.1, std::nan("")}) {
    EXPECT_THROW((void)chi_square_quantile(3, probability), std::invalid_argument) << probability;
  }
  EXPECT_THROW((void)chi_square_quantile(0, 0.5), std::invalid_argument);
  EXPECT_THROW((void)chi_square_cdf(0, 1.0), std::invalid_argument);
  EXPECT_THROW((void)chi_square_cdf(3, -1e-9), std::invalid_argument);
  EXPECT_THROW((void)chi_square_cdf(3, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace prf_core
