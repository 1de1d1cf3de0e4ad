// SPDX-License-Identifier: BSD-3-Clause
// Fits a predictor's parameters and the scale of the measurements' covariance to bags by the
// maximum likelihood of the innovations:  L = -1/2 sum (nu' S^-1 nu + ln det 2 pi S).
#include <unistd.h>

#include <ros/package.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <nlopt.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "bag_measurements.hpp"
#include "command.hpp"
#include "predictor_file.hpp"
#include "prf_predictor/predictors.hpp"

namespace prf_studies {
namespace {

constexpr double kLongestGap = 1.0;  // s without measurement, after which the filter starts again
constexpr double kFarthest = 1e4;    // factor that a parameter may change by
constexpr double kNearBound = 1.01;  // times the bound or nearer: at it
constexpr int kEvaluations = 300;
constexpr double kLeastMotion = 2.0;  // of the target, as a multiple of the measurements' noise
constexpr std::array<double, 5> kHorizons{0.1, 0.25, 0.5, 1.0, 2.0};  // s

using Series = std::vector<std::vector<TimedMeasurement>>;

struct Options {
  std::vector<std::string> bags;
  std::string predictor = "ukf";
  std::string from;
  std::string out;
  std::string json;
  std::string planning_frame = "j2s7s300_link_base";
  int tag_id = 0;
  std::optional<double> measurement_scale;
};

struct Figures {
  double log_likelihood = 0.0;  // per measurement
  double nis = 0.0;
  std::array<double, kHorizons.size()> rms_error{};  // m, of forecasts, against later measurements
};

// Runs the predictor over all measurements; with `with_errors` also compares forecasts.
Figures follow(const PredictorFile& file, const Series& series, bool with_errors) {
  Figures figures;
  std::size_t count = 0;
  std::array<std::size_t, kHorizons.size()> forecasts{};
  const auto target = file.make();
  for (const auto& measurements : series) {
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      const prf_predictor::TagMeasurement& measured = measurements[i].measurement;
      const Eigen::Matrix3d R = file.measurement_scale * measured.position_covariance;
      if (i == 0 || measurements[i].time - measurements[i - 1].time > kLongestGap) {
        target->begin(measured.position, R);
        continue;
      }
      target->advance(measurements[i].time - measurements[i - 1].time);
      const prf_predictor::PointForecast expected = target->forecast(0);
      const Eigen::Matrix3d S = expected.covariance.topLeftCorner<3, 3>() + R;
      const Eigen::Vector3d nu = measured.position - expected.position;
      const double nis = nu.dot(S.llt().solve(nu));
      figures.nis += nis;
      figures.log_likelihood -= 0.5 * (nis + std::log((2 * M_PI * S).determinant()));
      ++count;
      target->correct(measured.position, R);
      if (!with_errors) continue;
      for (std::size_t k = 0; k < kHorizons.size(); ++k) {
        std::size_t later = i;
        while (later < measurements.size() &&
               measurements[later].time < measurements[i].time + kHorizons[k]) {
          ++later;
        }
        if (later == measurements.size()) continue;
        const double ahead = measurements[later].time - measurements[i].time;
        if (ahead > kHorizons[k] + 0.05) continue;
        figures.rms_error[k] +=
            (target->forecast(ahead).position - measurements[later].measurement.position)
                .squaredNorm();
        ++forecasts[k];
      }
    }
  }
  figures.nis /= static_cast<double>(count);
  figures.log_likelihood /= static_cast<double>(count);
  for (std::size_t k = 0; k < kHorizons.size(); ++k) {
    figures.rms_error[k] = std::sqrt(figures.rms_error[k] /
                                     static_cast<double>(std::max<std::size_t>(1, forecasts[k])));
  }
  return figures;
}

// The parameters as a vector of logarithms, the measurement scale last unless it is kept; infinite
// ones stay.
class Fit {
 public:
  Fit(const PredictorFile& start, const Series& series, bool keeps_measurement_scale)
      : start_(start), series_(series), keeps_measurement_scale_(keeps_measurement_scale) {
    for (const auto& [key, value] : start.values) {
      if (std::isfinite(value)) keys_.push_back(key);
    }
  }

  PredictorFile run() {
    std::vector<double> x(keys_.size() + (keeps_measurement_scale_ ? 0 : 1), 0.0);
    nlopt::opt search(nlopt::LN_SBPLX, static_cast<unsigned>(x.size()));
    search.set_max_objective(&Fit::objective, this);
    search.set_lower_bounds(-std::log(kFarthest));
    search.set_upper_bounds(std::log(kFarthest));
    search.set_initial_step(1.0);
    search.set_ftol_abs(1e-5);
    search.set_maxeval(kEvaluations);
    double best = 0.0;
    has_converged_ = search.optimize(x, best) != nlopt::MAXEVAL_REACHED;
    if (isatty(STDERR_FILENO) != 0) std::cerr << "\n";
    note_bounds(x);
    return at(x);
  }

  [[nodiscard]] bool has_converged() const { return has_converged_; }
  // The parameters that the search wanted to take beyond its bounds, each with the bound.
  [[nodiscard]] const std::string& at_bounds() const { return at_bounds_; }

 private:
  static double objective(const std::vector<double>& x, std::vector<double>& /*gradient*/,
                          void* self) {
    auto& fit = *static_cast<Fit*>(self);
    const double value = follow(fit.at(x), fit.series_, false).log_likelihood;
    if (isatty(STDERR_FILENO) != 0 && ++fit.evaluations_ % 5 == 0) {
      std::fprintf(stderr, "\revaluation %d, log-likelihood %.4f ", fit.evaluations_, value);
    }
    return std::isfinite(value) ? value : -1e9;
  }

  void note_bounds(const std::vector<double>& x) {
    std::ostringstream text;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (std::log(kFarthest) - std::abs(x[i]) > std::log(kNearBound)) continue;
      text << (text.str().empty() ? "" : ", ")
           << (i < keys_.size() ? keys_[i] : "measurement_scale") << " on its "
           << (x[i] < 0.0 ? "lower bound, 1 / " : "upper bound, ") << kFarthest << " of the start";
    }
    at_bounds_ = text.str();
  }

  [[nodiscard]] PredictorFile at(const std::vector<double>& x) const {
    PredictorFile file = start_;
    for (std::size_t i = 0; i < keys_.size(); ++i) file.values[keys_[i]] *= std::exp(x[i]);
    if (!keeps_measurement_scale_) file.measurement_scale *= std::exp(x.back());
    return file;
  }

  PredictorFile start_;
  const Series& series_;
  bool keeps_measurement_scale_;
  std::vector<std::string> keys_;
  int evaluations_ = 0;
  bool has_converged_ = false;
  std::string at_bounds_;
};

// Throws unless the target moves, by the rms about the mean of its positions, by more than the
// noise that its measurements tell.
void require_motion(const std::string& bag, const std::vector<TimedMeasurement>& measurements) {
  const auto count = static_cast<double>(measurements.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& [time, measured] : measurements) mean += measured.position / count;
  double motion = 0.0, noise = 0.0;
  for (const auto& [time, measured] : measurements) {
    motion += (measured.position - mean).squaredNorm() / count;
    noise += measured.position_covariance.trace() / count;
  }
  if (std::sqrt(motion) > kLeastMotion * std::sqrt(noise)) return;
  std::ostringstream text;
  text << bag << ": the target does not move: its positions are " << 1e3 * std::sqrt(motion)
       << " mm rms about their mean, must be more than " << kLeastMotion << " times the noise of "
       << 1e3 * std::sqrt(noise) << " mm";
  throw std::invalid_argument(text.str());
}

void print(const char* label, const Figures& figures) {
  std::printf("%-8s %14.4f %7.2f", label, figures.log_likelihood, figures.nis);
  for (const double error : figures.rms_error) std::printf(" %8.2f", 1e3 * error);
  std::printf("\n");
}

nlohmann::json as_json(const PredictorFile& file, const Figures& figures) {
  nlohmann::json json{{"log_likelihood_per_measurement", figures.log_likelihood},
                      {"nis", figures.nis},
                      {"rms_error_m", figures.rms_error},
                      {"measurement_scale", file.measurement_scale}};
  for (const auto& [key, value] : file.values) {
    json[key] = std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
  }
  return json;
}

void write(const std::string& path, const std::string& content) {
  if (path.empty()) return;
  std::ofstream file(path);
  file << content;
  file.close();
  if (!file)
    throw std::invalid_argument(
        path + " cannot be written: is its folder there, and may this user write to it?");
}

void run(const Options& options) {
  PredictorFile before = read_predictor_file(
      !options.from.empty() ? options.from
                            : ros::package::getPath("prf_predictor") + "/config/predictors/" +
                                  options.predictor + ".yaml");
  if (options.measurement_scale) before.measurement_scale = *options.measurement_scale;
  if (before.values.empty() || before.predictor == "periodic" || before.predictor == "sines" ||
      before.predictor == "autoregressive") {
    throw std::invalid_argument(
        "predictor = " + before.predictor +
        ", has no noise to fit (its covariance comes from the errors of its "
        "own forecasts), must be ukf, paper, constant_velocity, "
        "constant_acceleration, oscillation or ekf");
  }
  (void)before.make();
  Series series;
  for (const std::string& bag : options.bags) {
    series.push_back(measurements_in_bag(bag, options.planning_frame, options.tag_id));
    require_motion(bag, series.back());
  }
  Fit fit(before, series, options.measurement_scale.has_value());
  const PredictorFile after = fit.run();
  const Figures old_figures = follow(before, series, true);
  const Figures new_figures = follow(after, series, true);

  std::printf("%-8s %14s %7s  rms error, mm, at 0.1 s  0.25 s  0.5 s  1 s  2 s\n", "",
              "log-likelihood", "NIS");
  print("before", old_figures);
  print("after", new_figures);
  for (const auto& [key, value] : after.values) {
    std::printf("%-24s %10.4g -> %.4g\n", key.c_str(), before.values.at(key), value);
  }
  std::printf("%-24s %10.4g -> %.4g\n", "measurement_scale", before.measurement_scale,
              after.measurement_scale);
  if (!fit.has_converged()) {
    std::printf("stopped after %d evaluations, before it converged\n", kEvaluations);
  }
  if (!fit.at_bounds().empty()) {
    throw std::invalid_argument("nothing is written: " + fit.at_bounds() +
                                ". The bags do not determine it: give others, or start elsewhere "
                                "with --from");
  }
  write(options.out, after.text());
  const nlohmann::json json{{"horizons_s", kHorizons},
                            {"before", as_json(before, old_figures)},
                            {"after", as_json(after, new_figures)}};
  write(options.json, json.dump() + "\n");
}

}  // namespace
}  // namespace prf_studies

int main(int argc, char** argv) {
  prf_studies::Options options;
  CLI::App app("Fits a predictor's noise to bags by the likelihood of the innovations",
               "fit_noise");
  app.add_option("BAG", options.bags)->required();
  app.add_option("--predictor", options.predictor)
      ->check(CLI::IsMember(prf_predictor::predictor_names()));
  app.add_option("--from", options.from, "file to start from instead of the packaged one");
  app.add_option("--out", options.out, "file for the fitted parameters");
  app.add_option("--json", options.json);
  app.add_option("--tag", options.tag_id, "number of the target's tag")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--planning-frame", options.planning_frame);
  app.add_option("--measurement-scale", options.measurement_scale,
                 "keeps the scale of the measurements' covariance at this")
      ->check(CLI::Range(1e-4, 1e4));
  return prf_studies::run_command(app, argc, argv, [&] { prf_studies::run(options); });
}
