// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "elte_planner/elte_energy.hpp"

namespace elte_planner {

// Demonstrations like drawn or guided ones: a sum of slow waves, about 1 m in extent.
inline Eigen::MatrixXd random_demonstration(Eigen::Index nodes, Eigen::Index dimensions,
                                            std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd zeta = Eigen::MatrixXd::Zero(nodes, dimensions);
  for (Eigen::Index j = 0; j < dimensions; ++j) {
    for (int wave = 1; wave <= 4; ++wave) {
      const double amplitude = 0.3 * normal(random) / wave;
      const double phase = M_PI * normal(random);
      for (Eigen::Index k = 0; k < nodes; ++k) {
        const double s = static_cast<double>(k) / static_cast<double>(nodes - 1);
        zeta(k, j) += amplitude * std::sin(M_PI * wave * s + phase);
      }
    }
  }
  return zeta;
}

inline ElteWeights random_weights(std::mt19937& random) {
  std::uniform_real_distribution<double> exponent(-6.0, 1.0);
  std::bernoulli_distribution coin(0.5);
  ElteWeights weights;
  weights.elastic = coin(random) ? 0.001 : std::pow(10.0, exponent(random));
  weights.bending = coin(random) ? 0.001 : std::pow(10.0, exponent(random));
  weights.laplacian = coin(random) ? Laplacian::kFreeEnds : Laplacian::kRowNormalised;
  return weights;
}

inline Eigen::VectorXd random_vector(Eigen::Index size, double scale, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, scale);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); });
}

}  // namespace elte_planner
