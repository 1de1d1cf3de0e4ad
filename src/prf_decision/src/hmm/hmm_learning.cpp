// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/hmm/hmm_learning.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <prf_core/require.hpp>
#include <random>
#include <sstream>
#include <stdexcept>

namespace prf_decision {
namespace {

struct Totals {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d transitions = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  // of the observations with a velocity
  std::array<Eigen::Vector3d, kIntents> sum;
  double log_likelihood = 0;
};

template <typename Visit>
void for_each_velocity(const std::vector<Sequence>& runs, const Visit& visit) {
  for (std::size_t run = 0; run < runs.size(); ++run) {
    for (std::size_t k = 0; k < runs[run].size(); ++k) {
      const Observation& o = runs[run][k];
      if (o.velocity) visit(run, static_cast<Eigen::Index>(k), *o.velocity, o.spread);
    }
  }
}

template <typename Visit>
void for_each_deviation(const std::vector<Sequence>& runs, const Visit& visit) {
  for (std::size_t run = 0; run < runs.size(); ++run) {
    for (std::size_t k = 0; k < runs[run].size(); ++k) {
      const Observation& o = runs[run][k];
      if (!o.velocity || !o.deviation) continue;
      visit(run, static_cast<Eigen::Index>(k), log_deviation(*o.deviation));
    }
  }
}

// E d d^T of the velocities that an observation stands for.
Eigen::Matrix3d moment_of(const Eigen::Vector3d& d, double spread) {
  return d * d.transpose() + spread * spread / 3 * Eigen::Matrix3d::Identity();
}

bool any_label(const std::vector<Sequence>& runs) {
  return std::any_of(runs.begin(), runs.end(), [](const Sequence& run) {
    return std::any_of(run.begin(), run.end(), [](const Observation& o) { return o.label; });
  });
}

[[noreturn]] void refuse_state(std::size_t state, double weight) {
  std::ostringstream text;
  text << kIntentNames[state] << " holds " << weight << " observations, must hold at least "
       << kLeastObservations;
  throw std::runtime_error(text.str());
}

Eigen::Matrix3d row_fractions(const Eigen::Matrix3d& counts, const Eigen::Matrix3d& otherwise) {
  Eigen::Matrix3d fractions = otherwise;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (counts.row(i).sum() > 0) fractions.row(i) = counts.row(i) / counts.row(i).sum();
  }
  return fractions;
}

// The second moment of all velocities, m^2/s^2.
Eigen::Matrix3d pooled_moment(const std::vector<Sequence>& runs) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double count = 0;
  for_each_velocity(runs, [&](std::size_t, Eigen::Index, const Eigen::Vector3d& o, double spread) {
    sum += moment_of(o, spread);
    count += 1;
  });
  if (count < kIntents * kLeastObservations) {
    throw std::invalid_argument("there are " + std::to_string(static_cast<int>(count)) +
                                " velocities, must be at least 12");
  }
  return sum / count;
}

// Of all deviations, the states one sigma apart; none without deviations.
std::optional<std::array<LogDeviation, kIntents>> first_deviations(
    const std::vector<Sequence>& runs) {
  double count = 0, sum = 0, squares = 0;
  for_each_deviation(runs, [&](std::size_t, Eigen::Index, double x) {
    count += 1;
    sum += x;
    squares += x * x;
  });
  if (count < kIntents * kLeastObservations) return std::nullopt;
  const double mean = sum / count;
  const double sigma = std::max(std::sqrt(std::max(squares / count - mean * mean, 0.0)), 0.01);
  return std::array{LogDeviation{mean - sigma, sigma}, LogDeviation{mean, sigma},
                    LogDeviation{mean + sigma, sigma}};
}

// The first one spreads the states evenly over the speeds, the others at random.
HmmParams first_guess(const Eigen::Matrix3d& moment, bool free_means, int restart,
                      std::mt19937& random) {
  std::array<double, kIntents> size{0.3, 0.8, 1.6};  // times the pooled moment's root
  double stay = 0.9;                                 // probability, for each state
  HmmParams guess;
  for (Eigen::Vector3d& mean : guess.mean) mean.setZero();
  if (restart > 0) {
    std::uniform_real_distribution<double> log_size(std::log(0.1), std::log(3.0));
    std::uniform_real_distribution<double> fraction(0.5, 0.99);
    std::normal_distribution<double> normal;
    for (double& value : size) value = std::exp(log_size(random));
    std::sort(size.begin(), size.end());
    stay = fraction(random);
    for (std::size_t i = 0; free_means && i < kIntents; ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        guess.mean[i][axis] = std::sqrt(moment(axis, axis)) * normal(random);
      }
    }
  }
  guess.initial.setConstant(1.0 / 3);
  guess.transition.setConstant((1 - stay) / 2);
  guess.transition.diagonal().setConstant(stay);
  for (std::size_t i = 0; i < kIntents; ++i) guess.covariance[i] = size[i] * size[i] * moment;
  return guess;
}

HmmParams in_order_of_speed(const HmmParams& parameters) {
  std::array<std::size_t, kIntents> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return mean_square_speed(parameters, a) < mean_square_speed(parameters, b);
  });
  HmmParams sorted;
  for (std::size_t i = 0; i < kIntents; ++i) {
    const auto to = static_cast<Eigen::Index>(i);
    const auto from = static_cast<Eigen::Index>(order[i]);
    sorted.initial[to] = parameters.initial[from];
    sorted.mean[i] = parameters.mean[order[i]];
    sorted.covariance[i] = parameters.covariance[order[i]];
    if (parameters.deviation) {
      if (!sorted.deviation) sorted.deviation.emplace();
      (*sorted.deviation)[i] = (*parameters.deviation)[order[i]];
    }
    for (std::size_t j = 0; j < kIntents; ++j) {
      sorted.transition(to, static_cast<Eigen::Index>(j)) =
          parameters.transition(from, static_cast<Eigen::Index>(order[j]));
    }
  }
  return sorted;
}

LearningResult climb(HmmParams parameters, const std::vector<Sequence>& runs,
                     const LearningParams& options, int restart, const OnIteration& on_iteration) {
  const double observations = std::accumulate(
      runs.begin(), runs.end(), 0.0,
      [](double sum, const Sequence& run) { return sum + static_cast<double>(run.size()); });
  LearningResult learned;
  learned.restart = restart;
  for (int iteration = 0; iteration < options.max_iterations && !learned.converged; ++iteration) {
    const EmStepResult step = em_step(parameters, runs, options.free_means);
    if (on_iteration) on_iteration(restart, iteration, step.log_likelihood);
    if (!learned.log_likelihood.empty()) {
      const double rise = step.log_likelihood - learned.log_likelihood.back();
      learned.converged = rise < options.tolerance * observations;
    }
    learned.log_likelihood.push_back(step.log_likelihood);
    parameters = step.parameters;
  }
  learned.parameters = any_label(runs) ? parameters : in_order_of_speed(parameters);
  learned.parameters.validate();
  return learned;
}

}  // namespace

void LearningParams::validate() const {
  using prf_core::require;
  require(restarts >= 1 && restarts <= 1000, "restarts", restarts, "1 .. 1000");
  require(max_iterations >= 2, "max_iterations", max_iterations, "at least 2");
  require(tolerance > 0 && std::isfinite(tolerance), "tolerance", tolerance, "> 0");
}

namespace {

// Mean and standard deviation of each state's deviations.
std::array<LogDeviation, kIntents> weighted_deviations(
    const std::vector<Sequence>& runs, const std::vector<Eigen::Matrix3Xd>& posterior) {
  std::array<double, kIntents> weight{}, sum{}, squares{};
  for_each_deviation(runs, [&](std::size_t run, Eigen::Index k, double x) {
    for (std::size_t i = 0; i < kIntents; ++i) {
      const double gamma = posterior[run](static_cast<Eigen::Index>(i), k);
      weight[i] += gamma;
      sum[i] += gamma * x;
      squares[i] += gamma * x * x;
    }
  });
  std::array<LogDeviation, kIntents> result;
  for (std::size_t i = 0; i < kIntents; ++i) {
    if (weight[i] < kLeastObservations) refuse_state(i, weight[i]);
    const double mean = sum[i] / weight[i];
    result[i] = {mean, std::sqrt(std::max(squares[i] / weight[i] - mean * mean, 0.0))};
  }
  return result;
}

}  // namespace

EmStepResult em_step(const HmmParams& parameters, const std::vector<Sequence>& runs,
                     bool free_means) {
  std::vector<Eigen::Matrix3Xd> posterior;
  Totals totals;
  for (Eigen::Vector3d& sum : totals.sum) sum.setZero();
  for (const Sequence& run : runs) {
    SmoothingResult smoothing = smooth(parameters, run);
    totals.first += smoothing.posterior.col(0);
    totals.transitions += smoothing.transitions;
    totals.log_likelihood += smoothing.log_likelihood;
    posterior.push_back(std::move(smoothing.posterior));
  }
  for_each_velocity(runs, [&](std::size_t run, Eigen::Index k, const Eigen::Vector3d& o, double) {
    totals.weight += posterior[run].col(k);
    for (std::size_t i = 0; i < kIntents; ++i) {
      totals.sum[i] += posterior[run](static_cast<Eigen::Index>(i), k) * o;
    }
  });

  EmStepResult step{parameters, totals.log_likelihood};
  HmmParams& next = step.parameters;
  next.initial = totals.first / totals.first.sum();
  next.transition = row_fractions(totals.transitions, parameters.transition);
  for (std::size_t i = 0; i < kIntents; ++i) {
    const double weight = totals.weight[static_cast<Eigen::Index>(i)];
    if (weight < kLeastObservations) refuse_state(i, weight);
    if (free_means) next.mean[i] = totals.sum[i] / weight;
    next.covariance[i].setZero();
  }
  for_each_velocity(
      runs, [&](std::size_t run, Eigen::Index k, const Eigen::Vector3d& o, double spread) {
        for (std::size_t i = 0; i < kIntents; ++i) {
          next.covariance[i] +=
              posterior[run](static_cast<Eigen::Index>(i), k) * moment_of(o - next.mean[i], spread);
        }
      });
  for (std::size_t i = 0; i < kIntents; ++i) {
    next.covariance[i] /= totals.weight[static_cast<Eigen::Index>(i)];
    next.covariance[i] = (0.5 * (next.covariance[i] + next.covariance[i].transpose())).eval();
  }
  if (parameters.deviation) next.deviation = weighted_deviations(runs, posterior);
  return step;
}

LearningResult learn(const std::vector<Sequence>& runs, const LearningParams& options,
                     const OnIteration& on_iteration) {
  options.validate();
  const Eigen::Matrix3d moment = pooled_moment(runs);
  const auto deviations = first_deviations(runs);
  std::mt19937 random(options.seed);
  LearningResult best;
  std::vector<std::string> refused;
  for (int restart = 0; restart < options.restarts; ++restart) {
    HmmParams guess = first_guess(moment, options.free_means, restart, random);
    guess.deviation = deviations;
    try {
      LearningResult learned = climb(guess, runs, options, restart, on_iteration);
      const bool better =
          best.log_likelihood.empty() || learned.log_likelihood.back() > best.log_likelihood.back();
      if (better) best = std::move(learned);
    } catch (const std::exception& error) {
      refused.push_back("restart " + std::to_string(restart) + ": " + error.what());
    }
  }
  if (best.log_likelihood.empty()) {
    throw std::invalid_argument("no valid model: " + refused.front());
  }
  best.refused = std::move(refused);
  return best;
}

}  // namespace prf_decision
