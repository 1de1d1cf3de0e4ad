// SPDX-License-Identifier: BSD-3-Clause
// Keeps forecasts until their time has come and says how good they proved, with a memory that
// fades: what a predictor needs to tell, without knowing the target's motion, which of several
// ways of foretelling it does best and how far off it is to be expected.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <deque>
#include <memory>
#include <vector>

namespace prf_predictor {

class ForecastLedger {
 public:
  static constexpr std::array<double, 5> kHorizons{0.1, 0.25, 0.5, 1.0, 2.0};  // s
  // Errors of forecasts so far apart in time are taken as independent, s.
  static constexpr std::array<double, kHorizons.size()> kIndependent{0.3, 0.5, 0.7, 1.0, 1.5};

  // For one horizon: where each candidate and where the forecast given out say the target will be,
  // and the variance that the latter promises, of each axis.
  struct Promise {
    Eigen::Matrix3Xd candidates;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  };
  using Promises = std::array<Promise, kHorizons.size()>;

  struct Score {
    double evidence = 0.0;         // s of forecasts that came due, faded
    Eigen::ArrayXd squared_error;  // m^2, mean of each candidate
    // Of each axis, the mean of (squared error - variance of the sight) / promised variance; below
    // 0 at worst when the errors are smaller than the sights can tell. 1 counts for the first
    // moment. Enlarged by (n + 3) / (n + 1) for n independent errors, as a variance known from few
    // must be.
    Eigen::Array3d excess = Eigen::Array3d::Ones();
  };

  ForecastLedger(Eigen::Index candidates, double memory);  // memory: s, fades to 1 / e

  // The target was seen: forecasts that have come due are scored.
  void observe(double time, const Eigen::Vector3d& position, const Eigen::Vector3d& variance);
  // To be called after observe() of the same time.
  void promise(double time, Promises promises);

  [[nodiscard]] Score score(std::size_t horizon) const;

 private:
  struct Entry {
    double time = 0.0;
    double duration = 0.0;  // s since the entry before
    Promises promises;
  };
  struct Sums {
    double evidence = 0.0;
    Eigen::ArrayXd squared_error;
    Eigen::Array3d excess = Eigen::Array3d::Zero();
    double scored_until = 0.0;  // forecasts made until then are scored or will never be
  };

  double memory_;
  bool has_seen_ = false;
  double seen_time_ = 0.0;
  Eigen::Vector3d seen_position_ = Eigen::Vector3d::Zero();
  std::deque<std::shared_ptr<const Entry>> entries_;
  std::array<Sums, kHorizons.size()> sums_;
};

// Where a horizon lies among those of the ledger: a fraction of the way from one to the next;
// beyond the ends the nearest.
struct BetweenHorizons {
  std::size_t lower = 0;
  std::size_t upper = 0;
  double fraction = 0.0;
};

[[nodiscard]] BetweenHorizons between_horizons(double horizon);

}  // namespace prf_predictor
