// SPDX-License-Identifier: BSD-3-Clause
// What predictor_benchmark runs: prints the median time of advance() and correct() in us.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <random>
#include <vector>

#include "predictor_file.hpp"
#include "prf_predictor/predictors.hpp"

namespace {

double median_us(prf_predictor::TargetPredictor& predictor) {
  constexpr int kSteps = 1100;
  constexpr int kFirst = 100;
  constexpr double kFrame = 1.0 / 30;
  const Eigen::Matrix3d R = 1e-7 * Eigen::Matrix3d::Identity();
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 3e-4);
  std::vector<double> times;
  for (int k = 0; k < kSteps; ++k) {
    const double swing = 0.05 * std::sin(2.4 * k * kFrame);
    const Eigen::Vector3d seen(swing + normal(random), normal(random), normal(random));
    if (k == 0) predictor.begin(seen, R);
    const auto start = std::chrono::steady_clock::now();
    predictor.advance(kFrame);
    predictor.correct(seen, R);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (k >= kFirst) times.push_back(1e6 * took.count());
  }
  std::nth_element(times.begin(), times.begin() + kSteps / 2 - kFirst / 2, times.end());
  return times[static_cast<std::size_t>(kSteps / 2 - kFirst / 2)];
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::invalid_argument("usage: time_predictors PREDICTOR.yaml");
    const auto file = prf_predictor::read_predictor_file(argv[1]);
    std::printf("%.3f\n", median_us(*prf_predictor::make_predictor(file.predictor, file.values)));
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    constexpr int kUsageError = 2;
    std::cerr << "time_predictors: " << error.what() << "\n";
    return kUsageError;
  }
}
