// SPDX-License-Identifier: BSD-3-Clause
// A filter bank: linear Kalman filters in parallel, one for each hypothesis about the motion of the
// target. All get the same measurements; which of them to believe is not decided here
// (model_weights.hpp).
//
// Periodic hypotheses: the platform has one frequency W of a geometric grid over
// [slowest, fastest], and its double,
//   x(t) = o(W) + o(2 W) + disturbance
// with o a damped oscillator (spectral_model.hpp) whose amplitude and phase on each axis are its
// state. There are two disturbance models: stepping (drift, wander, and fast shaking that is soon
// forgotten) and calm (a little drift and wander). Aperiodic hypotheses are a drift alone:
// constant velocity, velocities that decay, and rest.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "prf_predictor/forecast_scorer.hpp"
#include "prf_predictor/periodic/spectral_model.hpp"
#include "prf_predictor/periodic_params.hpp"

namespace prf_predictor {

// What a periodic hypothesis assumes beside the platform's oscillators.
struct DisturbanceModel {
  VelocityDecay drift;
  std::vector<DampedOscillator> oscillators;
  double damping_ratio = 0.0;  // of the platform's oscillators
};

class FilterBank {
 public:
  // Of every group of components over one time step.
  using Transitions = std::vector<std::vector<Transition>>;

  explicit FilterBank(const PeriodicParams& params);  // valid ones

  [[nodiscard]] std::size_t size() const { return hypotheses_->all.size(); }
  [[nodiscard]] double prior(std::size_t i) const { return hypotheses_->all[i].prior; }
  // rad/s; none: the hypothesis is not periodic.
  [[nodiscard]] const std::vector<double>& frequencies(std::size_t i) const {
    return hypotheses_->all[i].frequencies;
  }
  [[nodiscard]] std::shared_ptr<const Transitions> transitions(double dt) const;

  // All filters start from this measurement. `variance`: of each axis, m^2.
  void begin(const Eigen::Vector3d& position, double variance);
  // The motion is another one; `variance`: of the measurement that shows it.
  void unsettle(double variance);
  void advance(double dt);
  void correct(const Eigen::Vector3d& position, double variance);

  // By hypothesis i, `transitions` being those over the horizon.
  [[nodiscard]] Eigen::Vector3d position(std::size_t i, const Transitions& transitions) const;
  [[nodiscard]] SpectralBelief::Forecast forecast(std::size_t i,
                                                  const Transitions& transitions) const;

 private:
  struct Hypothesis {
    std::size_t group = 0;  // of components
    std::shared_ptr<const std::vector<int>> used;
    std::vector<double> frequencies;
    double prior = 0.0;
  };
  struct Hypotheses {
    std::vector<Components> groups;
    std::vector<Hypothesis> all;

    void add_periodic(const PeriodicParams& params, const DisturbanceModel& disturbance);
    void add_aperiodic(const VelocityDecay& decay);
  };
  [[nodiscard]] static std::shared_ptr<const Hypotheses> make_hypotheses(
      const PeriodicParams& params);

  static constexpr std::size_t kKnownTransitions = 16;

  mutable std::vector<std::pair<double, std::shared_ptr<const Transitions>>> known_transitions_;
  std::shared_ptr<const Hypotheses> hypotheses_;  // shared by copies, never changed
  std::vector<SpectralBelief> beliefs_;           // of each hypothesis
};

}  // namespace prf_predictor
