// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <prf_core/chi_square.hpp>
#include <prf_core/require.hpp>
#include <string>
#include <utility>

#include "prf_predictor/gaussian.hpp"
#include "prf_predictor/predictors.hpp"

namespace py = pybind11;

namespace prf_predictor {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// What the interface leaves to its caller, Python's is checked for.
class CheckedPredictor {
 public:
  explicit CheckedPredictor(std::unique_ptr<TargetPredictor> predictor)
      : predictor_(std::move(predictor)) {}

  void begin(const Vector3d& position, const Matrix3d& covariance) {
    check(position, covariance);
    predictor_->begin(position, covariance);
    begun_ = true;
  }

  void advance(double dt) {
    require_begun();
    prf_core::require_between("dt", dt, 0.0, kLongest, "s");
    predictor_->advance(dt);
  }

  void correct(const Vector3d& position, const Matrix3d& covariance) {
    require_begun();
    check(position, covariance);
    predictor_->correct(position, covariance);
  }

  PointForecast forecast(double horizon) const {
    require_begun();
    prf_core::require_between("horizon", horizon, 0.0, kLongest, "s");
    return predictor_->forecast(horizon);
  }

  std::optional<Periodicity> periodicity(double horizon) const {
    require_begun();
    prf_core::require_between("horizon", horizon, 0.0, kLongest, "s");
    return predictor_->periodicity(horizon);
  }

  CheckedPredictor clone() const {
    CheckedPredictor copy(predictor_->clone());
    copy.begun_ = begun_;
    return copy;
  }

 private:
  static constexpr double kLongest = 3600.0;    // s
  static constexpr double kFarthest = 10000.0;  // m

  static void check(const Vector3d& position, const Matrix3d& covariance) {
    prf_core::require(position.cwiseAbs().maxCoeff() <= kFarthest, "position", position.transpose(),
                      "finite and within +-10000 m");
    prf_core::require(is_covariance(covariance), "covariance", covariance.reshaped().transpose(),
                      "finite, symmetric and positive definite");
  }

  void require_begun() const {
    prf_core::require(begun_, "predictor", "without measurement", "begun by a measurement first");
  }

  std::unique_ptr<TargetPredictor> predictor_;
  bool begun_ = false;
};

void bind_predictor(py::module_& m) {
  py::class_<PointForecast>(m, "PointForecast", "Where the target will be at one horizon.")
      .def_readonly("position", &PointForecast::position, "(3,), m.")
      .def_readonly("velocity", &PointForecast::velocity, "(3,), m/s.")
      .def_readonly("covariance", &PointForecast::covariance,
                    "(6, 6) of position and velocity, m^2, m^2/s, m^2/s^2.");
  py::class_<Periodicity>(m, "Periodicity", "What a predictor knows of a periodic motion.")
      .def_readonly("probability", &Periodicity::probability, "That the motion is periodic.")
      .def_readonly("frequencies", &Periodicity::frequencies,
                    "Of the most probable periodic hypothesis, rad/s.");
  py::class_<CheckedPredictor>(m, "TargetPredictor",
                               "A predictor as in C++: begin(), then advance() and correct().")
      .def(py::init([](const std::string& name, const std::map<std::string, double>& values) {
             return CheckedPredictor(make_predictor(name, values));
           }),
           py::arg("name"), py::arg("values"),
           "values: exactly those of predictor_parameters(name), else ValueError.")
      .def("begin", &CheckedPredictor::begin, py::arg("position"), py::arg("covariance"),
           "Forget everything and start from a measurement. (3,), m, and (3, 3), m^2.")
      .def("advance", &CheckedPredictor::advance, py::arg("dt"), "Time passes, s, >= 0.")
      .def("correct", &CheckedPredictor::correct, py::arg("position"), py::arg("covariance"),
           "A measurement at the present time. (3,), m, and (3, 3), m^2.")
      .def("forecast", &CheckedPredictor::forecast, py::arg("horizon"), "horizon: s, >= 0.")
      .def("periodicity", &CheckedPredictor::periodicity, py::arg("horizon"),
           "As far as it matters at this horizon; None: the predictor does not ask.")
      .def("clone", &CheckedPredictor::clone, "One that shares nothing with this.");
  m.def("predictor_names", &predictor_names, "What TargetPredictor may name.");
  m.def("predictor_parameters", &predictor_parameters, py::arg("name"),
        "Names of the parameters of this predictor.");
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.doc() = "Predictors of a moving target.";
  bind_predictor(m);
  m.def("chi_square_quantile", &prf_core::chi_square_quantile, py::arg("degrees"),
        py::arg("probability"), "x with P(X <= x) = probability, X chi-square.");
  m.def("chi_square_cdf", &prf_core::chi_square_cdf, py::arg("degrees"), py::arg("x"),
        "P(X <= x), X chi-square.");
}

}  // namespace prf_predictor
