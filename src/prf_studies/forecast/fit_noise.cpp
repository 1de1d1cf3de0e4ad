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
#include <nlopt.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "bag_measurements.hpp"
#include "predictor_file.hpp"
#include "prf_predictor/predictors.hpp"

namespace prf_predictor {
namespace {

constexpr char kUsage[] =
    "usage: fit_noise BAG... [--predictor ukf] [--from FILE.yaml] [--out FILE.yaml]\n"
    "                 [--json FILE] [--tag 0] [--planning-frame j2s7s300_link_base]\n"
    "                 [--measurement-scale FACTOR]\n"
    "  --from: starts from this predictor's file instead of the packaged one\n"
    "  --measurement-scale: keeps the scale of the measurements' covariance at this, 1e-4 .. 1e4\n"
    "  --tag: number of the tag that is the target";
constexpr double kLongestGap = 1.0;  // s without sight, after which the filter begins anew
constexpr double kFarthest = 1e4;    // factor that a parameter may change by
constexpr int kEvaluations = 300;
constexpr std::array<double, 5> kHorizons{0.1, 0.25, 0.5, 1.0, 2.0};  // s

using Series = std::vector<std::vector<TimedMeasurement>>;

struct Options {
  std::vector<std::string> bags;
  std::string from;
  std::string out;
  std::string json;
  std::string planning_frame = "j2s7s300_link_base";
  int tag_id = 0;
  std::optional<double> measurement_scale;
};

double number(const std::string& option, const std::string& text, double lowest, double highest) {
  std::size_t used = 0;
  double value = NAN;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !(value >= lowest && value <= highest)) {
    std::ostringstream message;
    message << option << " = " << text << ", must be a number " << lowest << " .. " << highest;
    throw std::invalid_argument(message.str());
  }
  return value;
}

Options read_options(int argc, char** argv) {
  Options options;
  std::string predictor = "ukf";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      options.bags.push_back(word);
      continue;
    }
    if (word == "--help") throw std::invalid_argument(kUsage);
    if (i + 1 == argc) throw std::invalid_argument(word + " needs a value\n" + kUsage);
    const std::string value = argv[++i];
    if (word == "--predictor") {
      predictor = value;
    } else if (word == "--from") {
      options.from = value;
    } else if (word == "--out") {
      options.out = value;
    } else if (word == "--json") {
      options.json = value;
    } else if (word == "--planning-frame") {
      options.planning_frame = value;
    } else if (word == "--tag") {
      options.tag_id = static_cast<int>(number(word, value, 0, 1e6));
    } else if (word == "--measurement-scale") {
      options.measurement_scale = number(word, value, 1e-4, 1e4);
    } else {
      throw std::invalid_argument("unknown option " + word + "\n" + kUsage);
    }
  }
  if (options.bags.empty()) throw std::invalid_argument(kUsage);
  (void)predictor_parameters(predictor);
  if (options.from.empty()) {
    options.from =
        ros::package::getPath("prf_predictor") + "/config/predictors/" + predictor + ".yaml";
  }
  return options;
}

struct Figures {
  double log_likelihood = 0.0;  // per sight
  double nis = 0.0;
  std::array<double, kHorizons.size()> rms_error{};  // m, of forecasts from where later sights were
};

// Runs the predictor over all sights; with `with_errors` also compares forecasts.
Figures follow(const PredictorFile& file, const Series& series, bool with_errors) {
  Figures figures;
  std::size_t count = 0;
  std::array<std::size_t, kHorizons.size()> forecasts{};
  const auto target = make_predictor(file.predictor, file.values);
  for (const auto& sights : series) {
    for (std::size_t i = 0; i < sights.size(); ++i) {
      const TagMeasurement& seen = sights[i].measurement;
      const Eigen::Matrix3d R = file.measurement_scale * seen.position_covariance;
      if (i == 0 || sights[i].time - sights[i - 1].time > kLongestGap) {
        target->begin(seen.position, R);
        continue;
      }
      target->advance(sights[i].time - sights[i - 1].time);
      const PointForecast expected = target->forecast(0);
      const Eigen::Matrix3d S = expected.covariance.topLeftCorner<3, 3>() + R;
      const Eigen::Vector3d nu = seen.position - expected.position;
      const double nis = nu.dot(S.llt().solve(nu));
      figures.nis += nis;
      figures.log_likelihood -= 0.5 * (nis + std::log((2 * M_PI * S).determinant()));
      ++count;
      target->correct(seen.position, R);
      if (!with_errors) continue;
      for (std::size_t k = 0; k < kHorizons.size(); ++k) {
        std::size_t later = i;
        while (later < sights.size() && sights[later].time < sights[i].time + kHorizons[k]) {
          ++later;
        }
        if (later == sights.size()) continue;
        const double ahead = sights[later].time - sights[i].time;
        if (ahead > kHorizons[k] + 0.05) continue;
        figures.rms_error[k] +=
            (target->forecast(ahead).position - sights[later].measurement.position).squaredNorm();
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
    search.optimize(x, best);
    if (isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "\n");
    return at(x);
  }

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
};

void print(const char* label, const Figures& figures) {
  std::printf("%-8s %14.4f %7.2f", label, figures.log_likelihood, figures.nis);
  for (const double error : figures.rms_error) std::printf(" %8.2f", 1e3 * error);
  std::printf("\n");
}

std::string as_json(const PredictorFile& file, const Figures& figures) {
  std::ostringstream text;
  text << "{\"log_likelihood_per_sight\": " << figures.log_likelihood
       << ", \"nis\": " << figures.nis << ", \"rms_error_m\": [";
  for (std::size_t k = 0; k < kHorizons.size(); ++k) {
    text << (k > 0 ? ", " : "") << figures.rms_error[k];
  }
  text << "], \"measurement_scale\": " << file.measurement_scale;
  for (const auto& [key, value] : file.values) {
    text << ", \"" << key << "\": ";
    if (std::isfinite(value)) {
      text << value;
    } else {
      text << "null";
    }
  }
  return text.str() + "}";
}

void write(const std::string& path, const std::string& content) {
  if (path.empty()) return;
  std::ofstream file(path);
  file << content;
  file.close();
  if (!file) throw std::invalid_argument(path + " cannot be written");
}

void run(const Options& options) {
  PredictorFile before = read_predictor_file(options.from);
  if (options.measurement_scale) before.measurement_scale = *options.measurement_scale;
  if (before.values.empty() || before.predictor == "periodic" || before.predictor == "sines" ||
      before.predictor == "autoregressive") {
    throw std::invalid_argument("predictor = " + before.predictor +
                                ", has no noise to fit (its covariance follows from how its "
                                "forecasts proved), must be ukf, paper, constant_velocity, "
                                "constant_acceleration, oscillation or ekf");
  }
  (void)make_predictor(before.predictor, before.values);
  Series series;
  for (const std::string& bag : options.bags) {
    series.push_back(measurements_in_bag(bag, options.planning_frame, options.tag_id));
  }
  const PredictorFile after = Fit(before, series, options.measurement_scale.has_value()).run();
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
  write(options.out, text_of(after));
  write(options.json,
        "{\"horizons_s\": [0.1, 0.25, 0.5, 1, 2], \"before\": " + as_json(before, old_figures) +
            ", \"after\": " + as_json(after, new_figures) + "}\n");
}

}  // namespace
}  // namespace prf_predictor

int main(int argc, char** argv) {
  try {
    prf_predictor::run(prf_predictor::read_options(argc, argv));
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    constexpr int kUsageError = 2;
    std::cerr << "fit_noise: " << error.what() << "\n";
    return kUsageError;
  }
}
