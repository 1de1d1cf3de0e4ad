// SPDX-License-Identifier: BSD-3-Clause
// What forecast_error and consistency compute with: follows recorded motions with one predictor
// and writes one line of JSON for each, in the order given.
#include <Eigen/Cholesky>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "predictor_file.hpp"
#include "prf_predictor/predictors.hpp"
#include "prf_predictor/target_tracker.hpp"
#include "recorded_motion.hpp"

namespace prf_predictor {
namespace {

constexpr char kUsage[] =
    "usage: evaluate_predictor NODE.yaml PREDICTOR.yaml WARM_UP_S LATENCY_S HORIZONS COLUMNS "
    "SEED FILE.csv [SEED FILE.csv ...]\n  HORIZONS and COLUMNS: separated by commas";
constexpr double kRate = 30.0;  // images per second

struct Task {
  TrackerParams tracker;
  PredictorFile predictor;
  double warm_up = 0.0;
  double latency = 0.0;
  std::vector<double> horizons;
  std::array<std::string, 4> columns;
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

void print_list(const char* name, const std::vector<double>& values, const char* format = "%.6g") {
  std::printf(", \"%s\": [", name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) std::printf(", ");
    std::printf(format, values[i]);
  }
  std::printf("]");
}

// Squared errors of one horizon, summed, and NEES of every image.
struct HorizonFigures {
  int count = 0;
  double squared_error = 0.0;
  double squared_angle = 0.0;
  std::vector<double> nees;

  void add(const Belief& belief, double ahead, const std::optional<RecordedMotion::Pose>& truth) {
    if (!truth) return;
    const PointForecast forecast = belief.motion->forecast(ahead);
    const Eigen::Vector3d error = forecast.position - truth->position;
    ++count;
    squared_error += error.squaredNorm();
    squared_angle += std::pow(
        belief.rotation->forecast(ahead).orientation.angularDistance(truth->orientation), 2);
    const Eigen::Matrix3d P = forecast.covariance.topLeftCorner<3, 3>();
    nees.push_back(error.dot(P.llt().solve(error)));
  }
};

void evaluate(const Task& task, const std::string& path, std::uint32_t seed) {
  const RecordedMotion motion = read_motion(path, task.columns);
  TargetTracker tracker(task.tracker,
                        make_predictor(task.predictor.predictor, task.predictor.values));
  std::vector<HorizonFigures> figures(task.horizons.size());
  std::vector<double> nis;
  std::vector<double> orientation_nis;
  int gated = 0;
  int orientation_gated = 0;
  int steps = 0;
  std::chrono::duration<double> busy{0};
  for (const Sighting& sighting : see(motion, kRate, seed)) {
    const double t = motion.time.front() + 1e-9 * static_cast<double>(sighting.stamp);
    const auto begin = std::chrono::steady_clock::now();
    const TrackState state = tracker.process(sighting.stamp, sighting.sights).state;
    busy += std::chrono::steady_clock::now() - begin;
    ++steps;
    gated += state.gated ? 1 : 0;
    orientation_gated += state.orientation_gated ? 1 : 0;
    if (1e-9 * static_cast<double>(sighting.stamp) < task.warm_up || !state.belief) continue;
    if (state.nis > 0) nis.push_back(state.nis);
    if (state.orientation_nis > 0) orientation_nis.push_back(state.orientation_nis);
    for (std::size_t i = 0; i < figures.size(); ++i) {
      const double ahead = task.horizons[i] + task.latency;
      figures[i].add(*state.belief, ahead, motion.at(t + ahead));
    }
  }
  std::printf("{\"seed\": %u, \"step_us\": %.3f, \"gated\": %d, \"orientation_gated\": %d", seed,
              1e6 * busy.count() / std::max(steps, 1), gated, orientation_gated);
  std::printf(", \"images\": %d", steps);
  std::vector<double> counts;
  std::vector<double> squared;
  std::vector<double> squared_angles;
  for (const HorizonFigures& figure : figures) {
    counts.push_back(figure.count);
    squared.push_back(figure.squared_error);
    squared_angles.push_back(figure.squared_angle);
  }
  print_list("count", counts);
  print_list("squared_error_m2", squared, "%.9g");
  if (!motion.orientation.empty()) {
    print_list("squared_angle_rad2", squared_angles, "%.9g");
    print_list("orientation_nis", orientation_nis, "%.4g");
  }
  print_list("nis", nis, "%.4g");
  std::printf(", \"nees\": [");
  for (std::size_t i = 0; i < figures.size(); ++i) {
    std::printf("%s[", i > 0 ? ", " : "");
    for (std::size_t k = 0; k < figures[i].nees.size(); ++k) {
      std::printf("%s%.4g", k > 0 ? ", " : "", figures[i].nees[k]);
    }
    std::printf("]");
  }
  std::printf("]}\n");
  std::fflush(stdout);
}

int run(const std::vector<std::string>& words) {
  if (words.size() < 8 || words.size() % 2 != 0) throw std::invalid_argument(kUsage);
  Task task;
  task.tracker = read_tracker_params(words[0]);
  task.predictor = read_predictor_file(words[1]);
  (void)make_predictor(task.predictor.predictor, task.predictor.values);
  task.warm_up = std::stod(words[2]);
  task.latency = std::stod(words[3]);
  for (const std::string& horizon : split(words[4])) task.horizons.push_back(std::stod(horizon));
  const auto columns = split(words[5]);
  if (columns.size() != 4) throw std::invalid_argument("COLUMNS must be four names");
  std::copy(columns.begin(), columns.end(), task.columns.begin());
  for (std::size_t i = 6; i < words.size(); i += 2) {
    evaluate(task, words[i + 1], static_cast<std::uint32_t>(std::stoul(words[i])));
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace prf_predictor

int main(int argc, char** argv) {
  try {
    return prf_predictor::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    constexpr int kUsageError = 2;
    std::cerr << "evaluate_predictor: " << error.what() << "\n";
    return kUsageError;
  }
}
