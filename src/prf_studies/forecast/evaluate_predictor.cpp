// SPDX-License-Identifier: BSD-3-Clause
// What forecast_error and consistency compute with: tracks recorded motions with one predictor and
// writes one line of JSON for each, in the order given.
#include <Eigen/Cholesky>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <prf_core/require.hpp>
#include <string>
#include <vector>

#include "command.hpp"
#include "predictor_file.hpp"
#include "recorded_motion.hpp"

namespace prf_studies {
namespace {

using prf_predictor::TrackState;

constexpr double kRate = 30.0;  // images per second

struct Task {
  std::string node_file;
  std::string predictor_file;
  double warm_up = 0.0;  // s
  double latency = 0.0;  // s
  std::vector<double> horizons;
  std::vector<std::string> columns;
  std::vector<std::uint32_t> seeds;
  std::vector<std::string> motions;
};

// Squared errors of one horizon, summed, and the NEES of every image.
struct HorizonFigures {
  int count = 0;
  double squared_error = 0.0;
  double squared_angle = 0.0;
  std::vector<double> nees;

  void add(const prf_predictor::Belief& belief, double ahead, const prf_core::Pose& truth) {
    const prf_predictor::PointForecast forecast = belief.motion->forecast(ahead);
    const Eigen::Vector3d error = forecast.position - truth.position;
    ++count;
    squared_error += error.squaredNorm();
    squared_angle += std::pow(
        belief.rotation->forecast(ahead).orientation.angularDistance(truth.orientation), 2);
    const Eigen::Matrix3d P = forecast.covariance.topLeftCorner<3, 3>();
    nees.push_back(error.dot(P.llt().solve(error)));
  }
};

// All figures of one motion.
struct Figures {
  std::vector<HorizonFigures> horizons;
  std::vector<double> nis;
  std::vector<double> orientation_nis;
  int gated = 0;
  int orientation_gated = 0;
  int images = 0;
  double busy = 0.0;  // s

  void add(const TrackState& state) {
    if (state.nis > 0) nis.push_back(state.nis);
    if (state.orientation.nis > 0) orientation_nis.push_back(state.orientation.nis);
  }
};

Figures track(const Task& task, const RecordedMotion& motion, std::uint32_t seed) {
  prf_predictor::TargetTracker tracker(read_tracker_params(task.node_file),
                                       read_predictor_file(task.predictor_file).make());
  Figures figures;
  figures.horizons.resize(task.horizons.size());
  for (const Image& image : simulate_images(motion, kRate, seed)) {
    const double since = prf_core::to_seconds(image.stamp);
    const auto begin = std::chrono::steady_clock::now();
    const TrackState state = tracker.process(image.stamp, image.measurements).state;
    figures.busy += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ++figures.images;
    figures.gated += state.gated ? 1 : 0;
    figures.orientation_gated += state.orientation.gated ? 1 : 0;
    if (since < task.warm_up || !state.belief) continue;
    figures.add(state);
    for (std::size_t i = 0; i < task.horizons.size(); ++i) {
      const double ahead = task.horizons[i] + task.latency;
      const auto truth = motion.at(motion.time.front() + since + ahead);
      if (truth) figures.horizons[i].add(*state.belief, ahead, *truth);
    }
  }
  return figures;
}

nlohmann::json as_json(const Figures& figures, std::uint32_t seed, bool has_orientation) {
  nlohmann::json json{{"seed", seed},
                      {"step_us", 1e6 * figures.busy / std::max(figures.images, 1)},
                      {"gated", figures.gated},
                      {"orientation_gated", figures.orientation_gated},
                      {"images", figures.images},
                      {"nis", figures.nis}};
  if (has_orientation) json["orientation_nis"] = figures.orientation_nis;
  for (const HorizonFigures& horizon : figures.horizons) {
    json["count"].push_back(horizon.count);
    json["squared_error_m2"].push_back(horizon.squared_error);
    if (has_orientation) json["squared_angle_rad2"].push_back(horizon.squared_angle);
    json["nees"].push_back(horizon.nees);
  }
  return json;
}

void evaluate(const Task& task) {
  prf_core::require(task.seeds.size() == task.motions.size(), "number of seeds", task.seeds.size(),
                    "that of the motions");
  std::array<std::string, 4> columns;
  std::copy(task.columns.begin(), task.columns.end(), columns.begin());
  for (std::size_t i = 0; i < task.motions.size(); ++i) {
    const RecordedMotion motion = read_motion(task.motions[i], columns);
    const Figures figures = track(task, motion, task.seeds[i]);
    std::cout << as_json(figures, task.seeds[i], !motion.orientation.empty()) << std::endl;
  }
}

}  // namespace
}  // namespace prf_studies

int main(int argc, char** argv) {
  prf_studies::Task task;
  CLI::App app("Tracks recorded motions with one predictor; a line of JSON for each",
               "evaluate_predictor");
  app.add_option("NODE.yaml", task.node_file)->required();
  app.add_option("PREDICTOR.yaml", task.predictor_file)->required();
  app.add_option("MOTION.csv", task.motions)->required();
  app.add_option("--warm-up", task.warm_up, "that does not count, s");
  app.add_option("--latency", task.latency, "between image and forecast, s");
  app.add_option("--horizons", task.horizons, "s, separated by commas")->delimiter(',')->required();
  app.add_option("--columns", task.columns, "of time, x, y, z")
      ->delimiter(',')
      ->expected(4)
      ->required();
  app.add_option("--seeds", task.seeds, "of the noise, one for each motion")
      ->delimiter(',')
      ->required();
  return prf_studies::run_command(app, argc, argv, [&] { prf_studies::evaluate(task); });
}
