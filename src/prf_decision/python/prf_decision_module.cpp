// SPDX-License-Identifier: BSD-3-Clause
// The HMM for Python: the same code that the node runs. A run is an (n, 3) array of velocities, a
// row of NaN where the target was not measured, and n labels 0, 1, 2 or -1 (not known). A fourth
// column is the spread, a fifth the deviation (NaN: not known).
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "prf_decision/hmm.hpp"
#include "prf_decision/hmm/hmm_file.hpp"
#include "prf_decision/hmm/hmm_learning.hpp"
#include "prf_decision/hmm/hmm_sequence.hpp"

namespace py = pybind11;

namespace prf_decision {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Labels = std::vector<int>;

std::optional<ObservedMotion> observed(const Rows& motions, Eigen::Index k) {
  if (motions.row(k).head<3>().array().isNaN().all()) return std::nullopt;
  ObservedMotion observed;
  observed.velocity = motions.row(k).head<3>().transpose();
  if (motions.cols() > 3) observed.spread = motions(k, 3);
  if (motions.cols() > 4 && !std::isnan(motions(k, 4))) observed.deviation = motions(k, 4);
  return observed;
}

void require_columns(const Rows& motions) {
  if (motions.cols() >= 3 && motions.cols() <= 5) return;
  throw std::invalid_argument("velocities have " + std::to_string(motions.cols()) +
                              " columns, must be 3 to 5: velocity, spread, deviation");
}

Sequence to_core(const Rows& velocities, const Labels& labels) {
  require_columns(velocities);
  if (!labels.empty() && static_cast<Eigen::Index>(labels.size()) != velocities.rows()) {
    throw std::invalid_argument("labels has " + std::to_string(labels.size()) + " values for " +
                                std::to_string(velocities.rows()) + " velocities");
  }
  Sequence run(static_cast<std::size_t>(velocities.rows()));
  for (std::size_t k = 0; k < run.size(); ++k) {
    if (const auto motion = observed(velocities, static_cast<Eigen::Index>(k))) {
      run[k].velocity = motion->velocity;
      run[k].spread = motion->spread;
      run[k].deviation = motion->deviation;
    }
    if (labels.empty() || labels[k] == -1) continue;
    if (labels[k] < 0 || labels[k] > 2) {
      throw std::invalid_argument("label " + std::to_string(k) + " is " +
                                  std::to_string(labels[k]) + ", must be -1 .. 2");
    }
    run[k].label = static_cast<Intent>(labels[k]);
  }
  return run;
}

std::vector<Sequence> to_core(const std::vector<std::pair<Rows, Labels>>& runs) {
  std::vector<Sequence> result;
  for (const auto& [velocities, labels] : runs) result.push_back(to_core(velocities, labels));
  return result;
}

Labels to_python(const std::vector<Intent>& states) {
  Labels labels;
  for (const Intent state : states) labels.push_back(static_cast<int>(state));
  return labels;
}

// The posterior after each observation, as the node filters it, and ln P of all.
std::pair<Rows, double> filter(const HmmParams& parameters, const Rows& velocities) {
  require_columns(velocities);
  const HmmFilter hmm(parameters);
  HmmBelief belief = hmm.initial_belief();
  Rows posterior(velocities.rows(), 3);
  for (Eigen::Index k = 0; k < velocities.rows(); ++k) {
    const auto motion = observed(velocities, k);
    belief = motion ? hmm.observe(belief, *motion) : hmm.predict(belief);
    posterior.row(k) = belief.posterior.transpose();
  }
  return {posterior, belief.log_likelihood};
}

// Mean and sigma of each state; none: not observed.
std::optional<std::vector<std::pair<double, double>>> deviation_of(const HmmParams& parameters) {
  if (!parameters.deviation) return std::nullopt;
  std::vector<std::pair<double, double>> values;
  for (const auto& [mean, sigma] : *parameters.deviation) values.emplace_back(mean, sigma);
  return values;
}

LearningResult learn_runs(const std::vector<std::pair<Rows, Labels>>& runs, int restarts,
                          std::uint32_t seed, bool free_means, const OnIteration& on_iteration) {
  LearningParams options;
  options.restarts = restarts;
  options.seed = seed;
  options.free_means = free_means;
  return learn(to_core(runs), options, on_iteration);
}

}  // namespace
}  // namespace prf_decision

PYBIND11_MODULE(prf_decision, module) {
  using namespace prf_decision;
  module.attr("STATES") = std::vector<std::string>(kIntentNames.begin(), kIntentNames.end());

  py::class_<HmmParams>(module, "HmmParams")
      .def(py::init<>())
      .def_readwrite("initial", &HmmParams::initial)
      .def_readwrite("transition", &HmmParams::transition)
      .def_readwrite("mean", &HmmParams::mean)
      .def_readwrite("covariance", &HmmParams::covariance)
      .def_property_readonly("deviation", &deviation_of)
      .def_readwrite("weight", &HmmParams::weight)
      .def("validate", &HmmParams::validate);
  py::class_<LearningResult>(module, "LearningResult")
      .def_readonly("parameters", &LearningResult::parameters)
      .def_readonly("log_likelihood", &LearningResult::log_likelihood)
      .def_readonly("converged", &LearningResult::converged)
      .def_readonly("restart", &LearningResult::restart)
      .def_readonly("refused", &LearningResult::refused);

  module.def("load_hmm", &load_hmm, py::arg("path"));
  module.def("hmm_text", &hmm_text, py::arg("parameters"), py::arg("comment") = "");
  module.def("filter", &filter, py::arg("parameters"), py::arg("velocities"));
  module.def(
      "most_probable_path",
      [](const HmmParams& parameters, const Rows& velocities) {
        const ViterbiResult path = most_probable_path(parameters, to_core(velocities, {}));
        return std::pair(to_python(path.states), path.log_probability);
      },
      py::arg("parameters"), py::arg("velocities"));
  module.def("learn", &learn_runs, py::arg("runs"), py::arg("restarts") = 8, py::arg("seed") = 1,
             py::arg("free_means") = false, py::arg("on_iteration") = OnIteration());
  module.def(
      "draw",
      [](const HmmParams& parameters, std::size_t observations, std::uint32_t seed) {
        const Sequence run = draw(parameters, observations, seed);
        Rows velocities(static_cast<Eigen::Index>(run.size()), 3);
        std::vector<Intent> states;
        for (std::size_t k = 0; k < run.size(); ++k) {
          velocities.row(static_cast<Eigen::Index>(k)) = run[k].velocity->transpose();
          states.push_back(*run[k].label);
        }
        return std::pair(velocities, to_python(states));
      },
      py::arg("parameters"), py::arg("observations"), py::arg("seed"));
}
