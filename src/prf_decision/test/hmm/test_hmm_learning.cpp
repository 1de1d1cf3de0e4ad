// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/hmm/hmm_learning.hpp"

#include <gtest/gtest.h>

#include <random>

#include <cmath>
#include <string>

#include "prf_decision/hmm/hmm_sequence.hpp"
#include "scenario.hpp"

namespace prf_decision {
namespace {

constexpr double kTolerance = 1e-8;

Sequence without_labels(Sequence run) {
  for (Observation& observation : run) observation.label.reset();
  return run;
}

// The figures named kHmmlearn were printed by test/hmmlearn_reference.py, hmmlearn 0.3.3.
Sequence reference_run() {
  Sequence run;
  for (int k = 0; k < 300; ++k) {
    const double size = std::array{0.08, 0.2, 0.45}[static_cast<std::size_t>(k / 37 % 3)];
    const Eigen::Vector3d shape(std::sin(1.3 * k + 0.2), std::cos(2.1 * k),
                                std::sin(0.01 * k * k + 0.7 * k));
    run.push_back({size * shape, std::nullopt});
  }
  return run;
}

TEST(HmmSequence, GivesTheLikelihoodAndPosteriorOfHmmlearn) {
  const Eigen::Vector3d kHmmlearnPosterior(0.842975250566, 0.153881165873, 0.00314358356179);
  const SmoothingResult smoothing = smooth(skewed_hmm(), reference_run());
  EXPECT_NEAR(smoothing.log_likelihood, 331.386664764, kTolerance);
  EXPECT_NEAR((smoothing.posterior.col(150) - kHmmlearnPosterior).norm(), 0, kTolerance);
}

TEST(HmmSequence, GivesTheViterbiPathOfHmmlearn) {
  const std::string kHmmlearn =
      "000000000000000000000000000000000000000000000000000000000000000000000000111"
      "221112211122110221112211121111211111000000000000000000000000000000000000000"
      "000000000000000000000000010000000011122112211111111121112211122111221112000"
      "000000000000000000000000000000000000000000000000000000000000000000000011021";
  const ViterbiResult path = most_probable_path(skewed_hmm(), reference_run());
  EXPECT_NEAR(path.log_probability, 291.056357661, kTolerance);
  std::string states;
  for (const Intent state : path.states) states += std::to_string(static_cast<int>(state));
  EXPECT_EQ(states, kHmmlearn);
}

TEST(HmmLearning, TakesTheStepsOfHmmlearn) {
  const std::vector<double> kHmmlearnLikelihood{331.386664764, 444.35377092, 463.907385619,
                                                471.680382783, 474.376741474};
  Eigen::Matrix3d transition, mean, reverse;
  transition << 0.986143315203, 0.0138132579315, 4.34268651334e-05, 0.000673703675226,
      0.594519982977, 0.404806313348, 0.0566696990564, 0.42207333396, 0.521256966984;
  mean << -0.00154647848047, -0.00119618754555, 0.0123879625599, 0.188184847548, 0.0508334987602,
      -0.0532394412308, -0.242692253744, -0.0461642121822, 0.0644634845893;
  reverse << 0.043115285365, -0.0069722988255, -0.0283746523365, -0.0069722988255, 0.105003739609,
      0.029127565529, -0.0283746523365, 0.029127565529, 0.0844861230215;

  HmmParams hmm = skewed_hmm();
  for (const double log_likelihood : kHmmlearnLikelihood) {
    const EmStepResult step = em_step(hmm, {reference_run()}, true);
    EXPECT_NEAR(step.log_likelihood, log_likelihood, kTolerance);
    hmm = step.parameters;
  }
  EXPECT_NEAR((hmm.transition - transition).cwiseAbs().maxCoeff(), 0, kTolerance);
  EXPECT_NEAR((hmm.covariance[2] - reverse).cwiseAbs().maxCoeff(), 0, kTolerance);
  for (std::size_t i = 0; i < kIntents; ++i) {
    const Eigen::Vector3d expected = mean.row(static_cast<Eigen::Index>(i)).transpose();
    EXPECT_NEAR((hmm.mean[i] - expected).norm(), 0, kTolerance);
  }
}

TEST(HmmSequence, EndsWithThePosteriorOfTheFilterAndPredictsWithoutMeasurementsLikeIt) {
  Sequence run = without_labels(draw(skewed_hmm(), 50, 3));
  for (const std::size_t missing : {0u, 5u, 6u, 30u}) run[missing].velocity.reset();
  const HmmFilter filter(skewed_hmm());
  HmmBelief belief = filter.initial_belief();
  for (const Observation& o : run) {
    belief = o.velocity ? filter.observe(belief, {*o.velocity}) : filter.predict(belief);
  }
  const SmoothingResult smoothing = smooth(skewed_hmm(), run);
  EXPECT_NEAR((smoothing.posterior.col(49) - belief.posterior).norm(), 0, 1e-12);
  EXPECT_NEAR(smoothing.log_likelihood, belief.log_likelihood, 1e-10);
}

TEST(HmmSequence, RefusesWhatTheModelMakesImpossible) {
  const HmmParams hmm = usual_hmm();  // forward never becomes reverse at once
  const Sequence run{{std::nullopt, Intent::kForward}, {std::nullopt, Intent::kReverse}};
  EXPECT_THROW((void)smooth(hmm, run), std::invalid_argument);
  EXPECT_THROW((void)most_probable_path(hmm, run), std::invalid_argument);
  EXPECT_THROW((void)smooth(hmm, {}), std::invalid_argument);
}

TEST(HmmLearning, FindsTheModelThatTheRunsWereDrawnFromWithoutLabels) {
  HmmParams truth = usual_hmm();
  truth.transition << 0.9, 0.08, 0.02, 0.05, 0.9, 0.05, 0.02, 0.08, 0.9;
  LearningParams options;
  options.restarts = 2;
  const LearningResult learned =
      learn({without_labels(draw(truth, 4000, 1)), without_labels(draw(truth, 4000, 2))}, options);
  EXPECT_TRUE(learned.converged);
  EXPECT_LT((learned.parameters.transition - truth.transition).cwiseAbs().maxCoeff(), 0.03);
  for (std::size_t i = 0; i < kIntents; ++i) {
    const double fraction = mean_square_speed(learned.parameters, i) / mean_square_speed(truth, i);
    EXPECT_NEAR(fraction, 1, 0.1) << kIntentNames[i];
    EXPECT_TRUE(learned.parameters.mean[i].isZero(0)) << kIntentNames[i];
  }
}

// Three intents that move at different velocities and hardly vary: a first guess with random means
// finds them in any order.
TEST(HmmLearning, OrdersTheStatesBySpeedWhereverItFoundThem) {
  HmmParams truth = usual_hmm();
  truth.transition << 0.9, 0.08, 0.02, 0.05, 0.9, 0.05, 0.02, 0.08, 0.9;
  truth.mean = {Eigen::Vector3d{0.05, 0, 0}, Eigen::Vector3d{-0.2, 0.1, 0},
                Eigen::Vector3d{0.3, 0.2, 0.3}};
  for (Eigen::Matrix3d& covariance : truth.covariance) {
    covariance = 0.01 * Eigen::Matrix3d::Identity();
  }
  LearningParams options;
  options.free_means = true;
  options.restarts = 8;
  const LearningResult learned = learn({without_labels(draw(truth, 2000, 4))}, options);
  for (const std::string& reason : learned.refused) {
    EXPECT_EQ(reason.find("rms speed"), std::string::npos) << reason;
  }
  EXPECT_LT((learned.parameters.transition - truth.transition).cwiseAbs().maxCoeff(), 0.05);
  for (std::size_t i = 0; i < kIntents; ++i) {
    EXPECT_LT((learned.parameters.mean[i] - truth.mean[i]).norm(), 0.02) << kIntentNames[i];
  }
}

TEST(HmmLearning, NeverLowersTheLikelihood) {
  LearningParams options;
  options.restarts = 3;
  std::vector<std::vector<double>> climbs(3);
  (void)learn({without_labels(draw(usual_hmm(), 1500, 5))}, options,
              [&](int restart, int, double value) {
                climbs[static_cast<std::size_t>(restart)].push_back(value);
              });
  std::size_t steps = 0;
  for (const auto& climb : climbs) {
    for (std::size_t i = 1; i < climb.size(); ++i, ++steps) {
      EXPECT_GE(climb[i], climb[i - 1] - 1e-8);
    }
  }
  EXPECT_GE(steps, 50u);
}

TEST(HmmLearning, CountsWhereEverythingIsLabelled) {
  const Sequence run = draw(usual_hmm(), 3000, 6);
  Eigen::Matrix3d counts = Eigen::Matrix3d::Zero();
  for (std::size_t k = 1; k < run.size(); ++k) {
    const auto from = static_cast<Eigen::Index>(*run[k - 1].label);
    counts(from, static_cast<Eigen::Index>(*run[k].label)) += 1;
  }
  const LearningResult learned = learn({run}, LearningParams());
  EXPECT_LE(learned.log_likelihood.size(), 3u);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::RowVector3d fraction = counts.row(i) / counts.row(i).sum();
    EXPECT_NEAR((learned.parameters.transition.row(i) - fraction).norm(), 0, 1e-12);
  }
}

TEST(HmmLearning, GivesTheSameResultForTheSameSeed) {
  const Sequence run = without_labels(draw(usual_hmm(), 800, 7));
  const LearningResult once = learn({run}, LearningParams());
  const LearningResult again = learn({run}, LearningParams());
  EXPECT_EQ(once.log_likelihood, again.log_likelihood);
  EXPECT_EQ(once.parameters.transition, again.parameters.transition);
}

std::string refusal(const std::vector<Sequence>& runs, const LearningParams& options) {
  try {
    (void)learn(runs, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(HmmLearning, RefusesDeadStatesStatesOutOfOrderAndTooLittle) {
  const LearningParams options;
  Sequence calm = draw(usual_hmm(), 400, 8);
  for (Observation& o : calm) o.label = Intent::kForward;
  EXPECT_NE(refusal({calm}, options).find("pause holds 0 observations"), std::string::npos);

  Sequence swapped = draw(usual_hmm(), 2000, 9);
  for (Observation& o : swapped) o.label = static_cast<Intent>(2 - static_cast<int>(*o.label));
  EXPECT_NE(refusal({swapped}, options).find("gives an rms speed"), std::string::npos);

  EXPECT_NE(refusal({Sequence(40)}, options).find("velocities, must be"), std::string::npos);
  const Sequence still(100, {Eigen::Vector3d::Zero(), std::nullopt});
  EXPECT_NE(refusal({still}, options).find("smallest eigenvalue"), std::string::npos);
}

TEST(LearningParams, AreRefusedByName) {
  LearningParams options;
  options.restarts = 0;
  EXPECT_NE(refusal({}, options).find("restarts = 0"), std::string::npos);
  options = LearningParams();
  options.max_iterations = 1;
  EXPECT_NE(refusal({}, options).find("max_iterations = 1"), std::string::npos);
  options = LearningParams();
  options.tolerance = NAN;
  EXPECT_NE(refusal({}, options).find("tolerance = nan"), std::string::npos);
}

TEST(HmmLearning, LearnsSpreadAndDeviationOfLabelledObservations) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Sequence run;
  for (int k = 0; k < 9000; ++k) {
    const auto intent = static_cast<Intent>(k / 30 % 3);
    const double scale = 1 + static_cast<double>(static_cast<int>(intent));
    Observation o;
    o.velocity = 0.1 * scale * Eigen::Vector3d(normal(random), normal(random), normal(random));
    o.spread = 0.2 * scale;
    o.deviation = std::exp(-6 + scale + 0.4 * normal(random));
    o.label = intent;
    run.push_back(o);
  }
  const HmmParams learnt = learn({run}, LearningParams()).parameters;
  ASSERT_TRUE(learnt.deviation);
  for (std::size_t i = 0; i < kIntents; ++i) {
    const double scale = 1 + static_cast<double>(i);
    const double variance = scale * scale * (0.01 + 0.04 / 3);
    EXPECT_TRUE(learnt.covariance[i].isApprox(variance * Eigen::Matrix3d::Identity(), 0.05)) << i;
    const double lengthened = std::log(std::exp(-6 + scale) + kLeastDeviation);
    EXPECT_NEAR((*learnt.deviation)[i].mean, lengthened, 0.1) << i;
    EXPECT_LT((*learnt.deviation)[i].sigma, 0.41) << i;
  }
}

}  // namespace
}  // namespace prf_decision
