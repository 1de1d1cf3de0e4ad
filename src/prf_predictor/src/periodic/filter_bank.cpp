// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic/filter_bank.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace prf_predictor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// `count` values from first to last, neighbours at equal ratios.
std::vector<double> geometric(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(first * std::pow(last / first, static_cast<double>(i) / (count - 1)));
  }
  return values;
}

std::size_t index(int i) { return static_cast<std::size_t>(i); }

DisturbanceModel stepping(const PeriodicParams& p) {
  return {{p.drift_density_stepping, p.drift_time_constant},
          {{p.wander_frequency, p.wander_damping_ratio, p.wander_amplitude_stepping},
           {p.shake_frequency, p.shake_damping_ratio, p.shake_amplitude}},
          p.damping_ratio_stepping};
}

DisturbanceModel calm(const PeriodicParams& p) {
  return {{p.drift_density_calm, p.drift_time_constant},
          {{p.wander_frequency, p.wander_damping_ratio, p.wander_amplitude_calm}},
          p.damping_ratio_calm};
}

}  // namespace

void FilterBank::Hypotheses::add_periodic(const PeriodicParams& params,
                                          const DisturbanceModel& disturbance) {
  // Components: 0 the drift, then the disturbance's oscillators, the platform's, and their doubles.
  Components components{disturbance.drift, disturbance.oscillators};
  std::vector<int> common(components.oscillators.size() + 1);
  std::iota(common.begin(), common.end(), 0);
  const auto add = [&](const std::vector<int>& more, std::vector<double> of_platform) {
    std::vector<int> used = common;
    used.insert(used.end(), more.begin(), more.end());
    all.push_back({groups.size(), std::make_shared<std::vector<int>>(std::move(used)),
                   std::move(of_platform), 0.0});
  };

  const int count = static_cast<int>(params.frequency_count);
  const auto grid = geometric(params.slowest, params.fastest, count);
  const int first = static_cast<int>(common.size());
  for (const double multiple : {1.0, 2.0}) {
    const double sigma = multiple == 1 ? params.platform_amplitude : params.harmonic_amplitude;
    for (const double W : grid) {
      components.oscillators.push_back({multiple * W, disturbance.damping_ratio, sigma});
    }
  }
  for (int a = 0; a < count; ++a) {
    add({first + a, first + count + a}, {grid[index(a)]});
  }
  groups.push_back(std::move(components));
}

void FilterBank::Hypotheses::add_aperiodic(const VelocityDecay& decay) {
  all.push_back({groups.size(), std::make_shared<std::vector<int>>(1, 0), {}, 0.0});
  groups.push_back({decay, {}});
}

std::shared_ptr<const FilterBank::Hypotheses> FilterBank::make_hypotheses(
    const PeriodicParams& params) {
  auto hypotheses = std::make_shared<Hypotheses>();
  hypotheses->add_periodic(params, stepping(params));
  hypotheses->add_periodic(params, calm(params));
  const std::size_t periodic = hypotheses->all.size();
  hypotheses->add_aperiodic({params.moving_density, kInfinity});
  hypotheses->add_aperiodic({params.moving_density, params.long_time_constant});
  hypotheses->add_aperiodic({params.moving_density, params.short_time_constant});
  hypotheses->add_aperiodic({params.slow_density, params.long_time_constant});
  hypotheses->add_aperiodic({params.resting_density, params.short_time_constant});
  const std::size_t aperiodic = hypotheses->all.size() - periodic;
  for (std::size_t i = 0; i < hypotheses->all.size(); ++i) {
    hypotheses->all[i].prior = i < periodic
                                   ? params.periodic_prior / static_cast<double>(periodic)
                                   : params.aperiodic_prior / static_cast<double>(aperiodic);
  }
  return hypotheses;
}

FilterBank::FilterBank(const PeriodicParams& params) : hypotheses_(make_hypotheses(params)) {
  for (const double horizon : ForecastScorer::kHorizons) (void)transitions(horizon);
}

// Some steps come again and again: horizons, and the interval between two images.
std::shared_ptr<const FilterBank::Transitions> FilterBank::transitions(double dt) const {
  for (const auto& [known, result] : known_transitions_) {
    if (known == dt) return result;
  }
  auto result = std::make_shared<Transitions>();
  for (const Components& group : hypotheses_->groups) result->push_back(group.transitions(dt));
  if (known_transitions_.size() >= kKnownTransitions) {
    known_transitions_.erase(known_transitions_.begin() + ForecastScorer::kHorizons.size());
  }
  known_transitions_.emplace_back(dt, result);
  return result;
}

void FilterBank::begin(const Eigen::Vector3d& position, double variance) {
  beliefs_.clear();
  for (const Hypothesis& hypothesis : hypotheses_->all) {
    beliefs_.emplace_back(hypotheses_->groups[hypothesis.group], hypothesis.used, position,
                          variance);
  }
}

void FilterBank::unsettle(double variance) {
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    beliefs_[i].unsettle(hypotheses_->groups[hypotheses_->all[i].group], variance);
  }
}

void FilterBank::advance(double dt) {
  const auto shared = transitions(dt);
  const Transitions& over_dt = *shared;
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    beliefs_[i].advance(over_dt[hypotheses_->all[i].group]);
  }
}

void FilterBank::correct(const Eigen::Vector3d& position, double variance) {
  for (SpectralBelief& belief : beliefs_) belief.correct(position, variance);
}

Eigen::Vector3d FilterBank::position(std::size_t i, const Transitions& transitions) const {
  return beliefs_[i].position(transitions[hypotheses_->all[i].group]);
}

SpectralBelief::Forecast FilterBank::forecast(std::size_t i, const Transitions& transitions) const {
  return beliefs_[i].forecast(transitions[hypotheses_->all[i].group]);
}

}  // namespace prf_predictor
