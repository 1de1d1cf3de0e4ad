// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/hmm/hmm_file.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <regex>
#include <vector>

#include "scenario.hpp"

namespace prf_decision {
namespace {

const char* kValid = R"(
initial: {forward: 0.80, pause: 0.15, reverse: 0.05}
transition: {forward: [0.97, 0.03, 0.00], pause: [0.015, 0.97, 0.015], reverse: [0.00, 0.03, 0.97]}
mean: {forward: [0, 0, 0], pause: [0, 0, 0], reverse: [0, 0, 0]}
covariance:
  forward: [[0.0100, 0, 0], [0, 0.0100, 0], [0, 0, 0.0100]]
  pause: [[0.0361, 0, 0], [0, 0.0361, 0], [0, 0, 0.0361]]
  reverse: [[0.1296, 0, 0], [0, 0.1296, 0], [0, 0, 0.1296]]
)";

class HmmFile : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    std::ofstream(path_) << text;
    return path_;
  }
  ~HmmFile() override { std::remove(path_.c_str()); }

  const std::string path_ = testing::TempDir() + "prf_decision_hmm_file.yaml";
};

void expect_same(const HmmParams& a, const HmmParams& b) {
  EXPECT_TRUE(a.initial.isApprox(b.initial, 1e-12));
  EXPECT_TRUE(a.transition.isApprox(b.transition, 1e-12));
  for (std::size_t i = 0; i < kIntents; ++i) {
    EXPECT_TRUE(a.mean[i].isApprox(b.mean[i], 1e-12));
    EXPECT_TRUE(a.covariance[i].isApprox(b.covariance[i], 1e-12));
  }
}

TEST_F(HmmFile, GivesTheValuesThatAreWrittenInIt) {
  expect_same(load_hmm(write(kValid)), usual_hmm());
}

TEST_F(HmmFile, OfTheConfigurationIsValid) {
  const HmmParams hmm = load_hmm("config/hmm_paper.yaml");
  HmmParams expected = usual_hmm();
  expected.covariance = {Eigen::Matrix3d::Identity() * 0.15 * 0.15,
                         Eigen::Matrix3d::Identity() * 0.285 * 0.285,
                         Eigen::Matrix3d::Identity() * 0.54 * 0.54};
  expect_same(hmm, expected);
}

TEST_F(HmmFile, OfTheTrainedModelObservesTheDeviation) {
  EXPECT_TRUE(load_hmm("config/hmm_trained.yaml").deviation);
}

TEST_F(HmmFile, KeepsEveryDigitOfDeviations) {
  HmmParams hmm = usual_hmm();
  hmm.deviation = {LogDeviation{-5.0 / 3, 0.1}, LogDeviation{-1.1, 1.0 / 7},
                   LogDeviation{0.3, 2.0}};
  hmm.weight = 1.0 / 3;
  const HmmParams read = load_hmm(write(hmm_text(hmm, "")));
  ASSERT_TRUE(read.deviation);
  EXPECT_EQ(read.weight, hmm.weight);
  for (std::size_t i = 0; i < kIntents; ++i) {
    EXPECT_EQ((*read.deviation)[i].mean, (*hmm.deviation)[i].mean);
    EXPECT_EQ((*read.deviation)[i].sigma, (*hmm.deviation)[i].sigma);
  }
}

TEST_F(HmmFile, RefusesDeviationsThatDoNotRiseOrAreIncomplete) {
  const std::string valid(kValid);
  for (const char* wrong :
       {"deviation: {forward: [-3, 1], pause: [-3, 1], reverse: [-1, 1]}",
        "deviation: {forward: [-5, 1], pause: [-3, 0], reverse: [-1, 1]}",
        "deviation: {forward: [-5, 1], pause: [.nan, 1], reverse: [-1, 1]}",
        "deviation: {forward: [-5, 1], pause: [-3], reverse: [-1, 1]}",
        "deviation: {forward: [-5, 1], reverse: [-1, 1]}", "weight: 0", "weight: 1.1"}) {
    EXPECT_THROW(static_cast<void>(load_hmm(write(valid + wrong + "\n"))), std::invalid_argument)
        << wrong;
  }
}

TEST_F(HmmFile, KeepsEveryDigitWhenWrittenAndRead) {
  HmmParams hmm = skewed_hmm();
  hmm.initial.setConstant(1.0 / 3);
  hmm.transition.setConstant(1.0 / 3);
  for (std::size_t i = 0; i < kIntents; ++i) {
    hmm.mean[i] /= 3;
    hmm.covariance[i] /= 3;
  }
  const HmmParams read = load_hmm(write(hmm_text(hmm, "Two lines\nof comment")));
  EXPECT_EQ(read.initial, hmm.initial);
  EXPECT_EQ(read.transition, hmm.transition);
  EXPECT_EQ(read.mean, hmm.mean);
  EXPECT_EQ(read.covariance, hmm.covariance);

  HmmParams bad = hmm;
  bad.initial.setZero();
  EXPECT_THROW((void)hmm_text(bad, ""), std::invalid_argument);
}

TEST_F(HmmFile, ThatCannotBeReadIsNamed) {
  try {
    (void)load_hmm("no/such/file.yaml");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "no/such/file.yaml: there is no such file");
  }
}

// Fault 30: HMM file invalid (rows not 1, not sorted, negative, absurd) -> refused by name
TEST_F(HmmFile, WithAFaultIsRefusedWithItsNameAndTheCulprit) {
  struct Fault {
    const char* find;
    const char* replace;
    const char* culprit;
  };
  const std::vector<Fault> catalogue{
      {"initial:", "initials:", "unknown key 'initials'"},
      {"initial:[^\n]*\n", "", "missing key 'initial'"},
      {"mean: \\{forward", "mean: {foreward", "unknown key 'foreward' in mean"},
      {"pause: \\[0, 0, 0\\], ", "", "missing key 'pause' in mean"},
      {"0\\.80", "most", "initial.forward is most, must be a number"},
      {"0\\.80", "0.9", "initial sums to 1.1, must be 1"},
      {"0\\.80", "-0.8", "initial[0] is -0.8, must be in 0 .. 1"},
      {"0\\.80", ".nan", "initial[0] is nan"},
      {"\\[0\\.97, 0\\.03, 0\\.00\\]", "[0.97, 0.03]", "transition.forward is [0.97, 0.03]"},
      {"\\[0\\.97, 0\\.03, 0\\.00\\]", "[0.97, 0.02, 0]", "transition.forward sums to 0.99"},
      {"\\[0\\.00, 0\\.03, 0\\.97\\]", "[0, 0, 1]", "forward can never be reached from reverse"},
      {"0\\.0361, 0, 0", "-0.0361, 0, 0", "covariance.pause has smallest eigenvalue"},
      {"0\\.0361, 0, 0", "0.0361, 0.001, 0", "covariance.pause differs from its transpose"},
      {"0\\.0361, 0, 0", "0.0361, 0, x", "covariance.pause[0][2] is x, must be a number"},
      {"0\\.0361", "0.0050", "covariance.pause gives an rms speed"},
      {"reverse: \\[\\[", "reverse: [", "HMM file"},
      {"[^]*", "42", "the file is not a map"},
      {"[^]*", "", "the file is not a map"},
  };
  for (const auto& [find, replace, culprit] : catalogue) {
    const std::string text = std::regex_replace(std::string(kValid), std::regex(find), replace);
    ASSERT_NE(text, kValid) << find;
    try {
      (void)load_hmm(write(text));
      ADD_FAILURE() << "accepted: " << culprit;
    } catch (const std::invalid_argument& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(culprit), std::string::npos) << culprit << " not in: " << message;
      EXPECT_NE(message.find(path_), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace prf_decision
