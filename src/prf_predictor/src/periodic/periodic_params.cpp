// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic_params.hpp"

#include <cmath>
#include <prf_core/require.hpp>

namespace prf_predictor {

using prf_core::require;

namespace {

// Of all: no length, time, frequency, density or weight of a platform lies beyond.
constexpr double kLeast = 1e-9;
constexpr double kMost = 1e3;

}  // namespace

const std::vector<PeriodicParams::Member>& PeriodicParams::members() {
  using P = PeriodicParams;
  static const std::vector<Member> kMembers{
      {"slowest", &P::slowest},
      {"fastest", &P::fastest},
      {"frequency_count", &P::frequency_count},
      {"platform_amplitude", &P::platform_amplitude},
      {"harmonic_amplitude", &P::harmonic_amplitude},
      {"damping_ratio_stepping", &P::damping_ratio_stepping},
      {"damping_ratio_calm", &P::damping_ratio_calm},
      {"shake_frequency", &P::shake_frequency},
      {"shake_damping_ratio", &P::shake_damping_ratio},
      {"shake_amplitude", &P::shake_amplitude},
      {"drift_density_stepping", &P::drift_density_stepping},
      {"drift_density_calm", &P::drift_density_calm},
      {"drift_time_constant", &P::drift_time_constant},
      {"wander_frequency", &P::wander_frequency},
      {"wander_damping_ratio", &P::wander_damping_ratio},
      {"wander_amplitude_stepping", &P::wander_amplitude_stepping},
      {"wander_amplitude_calm", &P::wander_amplitude_calm},
      {"moving_density", &P::moving_density},
      {"slow_density", &P::slow_density},
      {"resting_density", &P::resting_density},
      {"long_time_constant", &P::long_time_constant},
      {"short_time_constant", &P::short_time_constant},
      {"autoregressive_window", &P::autoregressive_window},
      {"autoregressive_order", &P::autoregressive_order},
      {"memory", &P::memory},
      {"periodic_prior", &P::periodic_prior},
      {"aperiodic_prior", &P::aperiodic_prior},
      {"autoregressive_prior", &P::autoregressive_prior},
      {"innovation_memory", &P::innovation_memory},
      {"least_noise_share", &P::least_noise_share},
      {"least_inflation", &P::least_inflation},
  };
  return kMembers;
}

void PeriodicParams::validate() const {
  for (const auto& [name, member] : members()) {
    prf_core::require_between(name, this->*member, kLeast, kMost);
  }
  require(fastest > slowest, "fastest", fastest, "> slowest");
  const auto is_whole = [](double value) { return value == std::floor(value); };
  require(is_whole(frequency_count) && frequency_count >= 2 && frequency_count <= 40,
          "frequency_count", frequency_count, "a whole number 2 .. 40");
  for (const auto& [name, ratio] : {std::pair{"damping_ratio_stepping", damping_ratio_stepping},
                                    {"damping_ratio_calm", damping_ratio_calm},
                                    {"shake_damping_ratio", shake_damping_ratio},
                                    {"wander_damping_ratio", wander_damping_ratio}}) {
    require(ratio < 1, name, ratio, "> 0 and < 1");
  }
}

}  // namespace prf_predictor
