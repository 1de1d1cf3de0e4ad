// SPDX-License-Identifier: BSD-3-Clause
// What predictor_benchmark runs: prints the median time of advance() and correct() in us.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "command.hpp"
#include "predictor_file.hpp"

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
    const double wave = 0.05 * std::sin(2.4 * k * kFrame);
    const Eigen::Vector3d measured(wave + normal(random), normal(random), normal(random));
    if (k == 0) predictor.begin(measured, R);
    const auto start = std::chrono::steady_clock::now();
    predictor.advance(kFrame);
    predictor.correct(measured, R);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (k >= kFirst) times.push_back(1e6 * took.count());
  }
  std::nth_element(times.begin(), times.begin() + kSteps / 2 - kFirst / 2, times.end());
  return times[static_cast<std::size_t>(kSteps / 2 - kFirst / 2)];
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Median time of one prediction and correction, us", "time_predictors");
  std::string file;
  app.add_option("PREDICTOR.yaml", file)->required();
  return prf_studies::run_command(app, argc, argv, [&] {
    std::printf("%.3f\n", median_us(*prf_studies::read_predictor_file(file).make()));
  });
}
