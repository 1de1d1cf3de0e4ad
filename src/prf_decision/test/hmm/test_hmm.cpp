// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/hmm.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "scenario.hpp"

namespace prf_decision {
namespace {

double density(const HmmParams& hmm, std::size_t state, const Eigen::Vector3d& o) {
  const Eigen::Vector3d d = o - hmm.mean[state];
  const Eigen::Matrix3d& s = hmm.covariance[state];
  return std::exp(-0.5 * d.dot(s.inverse() * d)) /
         std::sqrt(std::pow(2 * M_PI, 3) * s.determinant());
}

// P(state at the end, observations) by summing over every state sequence.
Eigen::Vector3d enumerate(const HmmParams& hmm, const std::vector<Eigen::Vector3d>& o) {
  Eigen::Vector3d joint = Eigen::Vector3d::Zero();
  const auto sequences = static_cast<std::size_t>(std::lround(std::pow(3, o.size())));
  for (std::size_t code = 0; code < sequences; ++code) {
    std::size_t rest = code;
    std::size_t state = rest % 3;
    double p = hmm.initial[static_cast<Eigen::Index>(state)] * density(hmm, state, o[0]);
    for (std::size_t k = 1; k < o.size(); ++k) {
      rest /= 3;
      const std::size_t next = rest % 3;
      p *= hmm.transition(static_cast<Eigen::Index>(state), static_cast<Eigen::Index>(next)) *
           density(hmm, next, o[k]);
      state = next;
    }
    joint[static_cast<Eigen::Index>(state)] += p;
  }
  return joint;
}

TEST(HmmFilter, EqualsTheEnumerationOfAllStateSequences) {
  const HmmParams hmm = skewed_hmm();
  const HmmFilter filter(hmm);
  std::mt19937 random(1);
  std::normal_distribution<double> velocity(0, 0.3);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Eigen::Vector3d> o;
    HmmBelief belief = filter.initial_belief();
    for (int k = 0; k < 7; ++k) {
      o.emplace_back(velocity(random), velocity(random), velocity(random));
      belief = filter.observe(belief, {o.back()});
      const Eigen::Vector3d joint = enumerate(hmm, o);
      EXPECT_NEAR((belief.posterior - joint / joint.sum()).cwiseAbs().maxCoeff(), 0, 1e-12);
      EXPECT_NEAR(belief.log_likelihood, std::log(joint.sum()), 1e-11);
    }
  }
}

TEST(HmmFilter, StaysADistributionUnderFarOutliers) {
  const HmmFilter filter(usual_hmm());
  HmmBelief belief = filter.initial_belief();
  for (const double speed : {0.0, 1e3, 0.0, 1e6, -50.0, 0.1}) {
    belief = filter.observe(belief, {{speed, 0, 0}});
    EXPECT_TRUE(belief.posterior.allFinite());
    EXPECT_NEAR(belief.posterior.sum(), 1, 1e-12);
    EXPECT_GE(belief.posterior.minCoeff(), 0);
    EXPECT_TRUE(std::abs(speed) < 1 || belief.posterior[2] > 1 - 1e-12) << speed;
  }
}

TEST(HmmFilter, DriftsToTheStationaryDistributionWithoutObservations) {
  const HmmParams hmm = skewed_hmm();
  const HmmFilter filter(hmm);
  HmmBelief belief = filter.observe(filter.initial_belief(), {{0, 0, 0}});
  for (int k = 0; k < 500; ++k) belief = filter.predict(belief);
  EXPECT_NEAR((hmm.transition.transpose() * belief.posterior - belief.posterior).norm(), 0, 1e-12);
}

TEST(HmmFilter, DoesNotSpendTheInitialDistributionBeforeTheFirstObservation) {
  const HmmFilter filter(skewed_hmm());
  const HmmBelief belief = filter.initial_belief();
  EXPECT_EQ(belief.posterior, skewed_hmm().initial);
  EXPECT_FALSE(belief.started);
}

TEST(HmmFilter, RefusesAVelocityThatIsNotFinite) {
  const HmmFilter filter(usual_hmm());
  EXPECT_THROW((void)filter.observe(filter.initial_belief(), {{NAN, 0, 0}}), std::invalid_argument);
}

// Fault 43: velocity of 1e300 -> cut to 20 m/s, counts as reverse; the next calm ones recover
TEST(HmmFilter, BoundsAnObservationBeforeItIsUsed) {
  const HmmFilter filter(usual_hmm());
  for (const ObservedMotion& absurd :
       {ObservedMotion{{1e300, -1e300, 1e300}, 0}, ObservedMotion{{0, 0, 0}, 1e300}}) {
    HmmBelief belief = filter.observe(filter.initial_belief(), absurd);
    EXPECT_TRUE(is_distribution(belief.posterior));
    EXPECT_EQ(most_probable(belief), Intent::kReverse);
    for (int k = 0; k < 30; ++k) belief = filter.observe(belief, {{0, 0, 0}});
    EXPECT_EQ(most_probable(belief), Intent::kForward);
  }
  EXPECT_THROW((void)filter.observe(filter.initial_belief(), {{0, 0, 0}, NAN}),
               std::invalid_argument);
}

// A5: posterior that is no distribution -> reset to the initial one, counts as reverse until
// observed
TEST(HmmFilter, ResetsAPosteriorThatIsNoDistribution) {
  const HmmFilter filter(usual_hmm());
  for (const Eigen::Vector3d& broken :
       {Eigen::Vector3d(NAN, NAN, NAN), Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, -1, 0)}) {
    const HmmBelief belief{broken, true, 0, false};
    EXPECT_EQ(most_probable(belief), Intent::kReverse);
    for (HmmBelief reset : {filter.predict(belief), filter.observe(belief, {{0, 0, 0}})}) {
      EXPECT_EQ(reset.posterior, usual_hmm().initial);
      EXPECT_TRUE(reset.was_reset);
      EXPECT_EQ(most_probable(reset), Intent::kReverse);
      EXPECT_EQ(most_probable(filter.predict(reset)), Intent::kReverse);
      reset = filter.observe(reset, {{0, 0, 0}});
      EXPECT_FALSE(reset.was_reset);
      EXPECT_EQ(most_probable(reset), Intent::kForward);
    }
  }
}

// The expectation over N(o, s^2/3 I), by a large sample of it.
TEST(EmissionModel, TakesTheExpectationOverTheSpread) {
  const EmissionModel emission(skewed_hmm());
  const ObservedMotion observed{{0.1, -0.2, 0.05}, 0.3};
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 0.3 / std::sqrt(3.0));
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  constexpr int kDraws = 200000;
  for (int k = 0; k < kDraws; ++k) {
    const Eigen::Vector3d offset(normal(random), normal(random), normal(random));
    mean += emission.log_density(Eigen::Vector3d(observed.velocity + offset)) / kDraws;
  }
  // Three standard errors of the widest: about 6 / sqrt(200000).
  EXPECT_LT((mean - emission.log_density(observed)).cwiseAbs().maxCoeff(), 0.05);
}

TEST(HmmFilter, GetsNoBolderWithMoreSpeedOrMoreSpread) {
  const HmmFilter filter(usual_hmm());
  for (const bool spread : {false, true}) {
    Intent boldest = Intent::kForward;
    for (double size = 0; size < 3; size += 0.05) {
      HmmBelief belief = filter.initial_belief();
      for (int k = 0; k < 20; ++k) {
        belief = filter.observe(
            belief, spread ? ObservedMotion{{0.1, 0, 0}, size} : ObservedMotion{{size, 0, 0}, 0.1});
      }
      EXPECT_GE(most_probable(belief), boldest) << size;
      boldest = most_probable(belief);
    }
    EXPECT_EQ(boldest, Intent::kReverse);
  }
}

TEST(HmmFilter, PrefersTheMoreCautiousStateWhenEqual) {
  HmmBelief belief;
  belief.posterior << 0.5, 0.5, 0;
  EXPECT_EQ(most_probable(belief), Intent::kPause);
}

TEST(HmmParams, RefusesEveryEntryOfTheCatalogueByName) {
  using Spoil = std::function<void(HmmParams&)>;
  const std::vector<std::pair<std::string, Spoil>> catalogue{
      {"initial sums", [](auto& h) { h.initial << 0.5, 0.3, 0.3; }},
      {"initial[1]", [](auto& h) { h.initial << 0.9, -0.2, 0.3; }},
      {"initial[0]", [](auto& h) { h.initial << NAN, 0.5, 0.5; }},
      {"transition.pause sums", [](auto& h) { h.transition(1, 1) = 0.9; }},
      {"transition.reverse[0]", [](auto& h) { h.transition.row(2) << -0.1, 0.1, 1.0; }},
      {"reverse can never be reached", [](auto& h) { h.transition.row(1) << 0.1, 0.9, 0; }},
      {"forward can never be reached from reverse",
       [](auto& h) { h.transition.row(2) << 0, 0, 1; }},
      {"mean.forward", [](auto& h) { h.mean[0].x() = INFINITY; }},
      {"mean.reverse", [](auto& h) { h.mean[2].x() = 21; }},
      {"covariance.reverse has largest", [](auto& h) { h.covariance[2] *= 1e308; }},
      {"covariance.pause is not finite", [](auto& h) { h.covariance[1](0, 0) = NAN; }},
      {"covariance.pause differs", [](auto& h) { h.covariance[1](0, 1) = 0.01; }},
      {"covariance.forward has smallest eigenvalue", [](auto& h) { h.covariance[0].setZero(); }},
      {"covariance.pause has smallest eigenvalue",
       [](auto& h) { h.covariance[1].setConstant(0.04); }},
      {"covariance.pause gives an rms speed",
       [](auto& h) { std::swap(h.covariance[0], h.covariance[1]); }},
      {"covariance.reverse gives an rms speed", [](auto& h) { h.covariance[2] = h.covariance[1]; }},
  };
  for (const auto& [culprit, spoil] : catalogue) {
    HmmParams hmm = usual_hmm();
    ASSERT_NO_THROW(hmm.validate());
    spoil(hmm);
    try {
      hmm.validate();
      ADD_FAILURE() << "accepted: " << culprit;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(culprit), std::string::npos)
          << culprit << " not in: " << error.what();
    }
  }
}

// Bayes' rule with the two densities written out.
TEST(HmmFilter, CountsTheWeightOfAnObservation) {
  HmmParams hmm = usual_hmm();
  hmm.weight = 0.25;
  const HmmFilter quarter(hmm);
  const HmmFilter whole(usual_hmm());
  const Eigen::Vector3d velocity(0.3, -0.2, 0.1);
  const auto odds = [&](const HmmFilter& filter) {
    const HmmBelief belief = filter.observe(filter.initial_belief(), {velocity});
    return Eigen::Vector3d(belief.posterior.cwiseQuotient(usual_hmm().initial).array().log());
  };
  const Eigen::Vector3d a = odds(whole);
  const Eigen::Vector3d b = odds(quarter);
  EXPECT_NEAR(b[1] - b[0], 0.25 * (a[1] - a[0]), 1e-9);
  EXPECT_NEAR(b[2] - b[1], 0.25 * (a[2] - a[1]), 1e-9);
}

TEST(HmmFilter, ObservesADeviationBesideTheVelocity) {
  HmmParams hmm = usual_hmm();
  hmm.deviation = {LogDeviation{-5, 0.6}, LogDeviation{-3.4, 0.5}, LogDeviation{-2.7, 0.6}};
  const HmmFilter filter(hmm);
  const Eigen::Vector3d velocity(0.2, -0.1, 0.05);
  const double deviation = 0.05;
  const HmmBelief belief = filter.observe(filter.initial_belief(), {velocity, 0, deviation});
  Eigen::Vector3d joint;
  for (std::size_t i = 0; i < kIntents; ++i) {
    const double variance = hmm.covariance[i](0, 0);
    const double off = (std::log(deviation + kLeastDeviation) - (*hmm.deviation)[i].mean) /
                       (*hmm.deviation)[i].sigma;
    joint[static_cast<Eigen::Index>(i)] =
        hmm.initial[static_cast<Eigen::Index>(i)] * std::pow(variance, -1.5) *
        std::exp(-0.5 * velocity.squaredNorm() / variance - 0.5 * off * off) /
        (*hmm.deviation)[i].sigma;
  }
  EXPECT_TRUE(belief.posterior.isApprox(joint / joint.sum(), 1e-9));
  // Where it is not known, and in a model that does not observe it, the velocity alone counts.
  const HmmFilter plain(usual_hmm());
  const auto without = filter.observe(filter.initial_belief(), {velocity});
  const auto ignored = plain.observe(plain.initial_belief(), {velocity, 0, deviation});
  EXPECT_TRUE(without.posterior.isApprox(ignored.posterior, 1e-12));
  EXPECT_THROW(static_cast<void>(filter.observe(belief, {velocity, 0, -0.1})),
               std::invalid_argument);
}

}  // namespace
}  // namespace prf_decision
