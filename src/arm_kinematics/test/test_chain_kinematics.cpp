// SPDX-License-Identifier: BSD-3-Clause
#include "arm_kinematics/chain_kinematics.hpp"

#include <gtest/gtest.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <random>
#include <stdexcept>

#include "arms.hpp"

namespace arm_kinematics {
namespace {

ChainKinematics arm(int joints) {
  return ChainKinematics(chain_from_urdf(arm_urdf(joints), "base", "tip"));
}

class Draw {
 public:
  explicit Draw(unsigned seed) : generator_(seed) {}
  JointVector joints(const ArmKinematics& of) {
    const JointLimits& limits = of.limits();
    JointVector q(of.joint_count());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = std::uniform_real_distribution<>(std::max(limits.lower[i], -M_PI),
                                              std::min(limits.upper[i], M_PI))(generator_);
    }
    return q;
  }

 private:
  std::mt19937 generator_;
};

void expect_within_limits(const ArmKinematics& of, const JointVector& q) {
  EXPECT_TRUE((q.array() >= of.limits().lower.array()).all()) << q.transpose();
  EXPECT_TRUE((q.array() <= of.limits().upper.array()).all()) << q.transpose();
}

class AnyArm : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Joints, AnyArm, testing::Values(5, 6, 7, 8));

TEST_P(AnyArm, HasThePlacementOfKdl) {
  const ChainKinematics chain = arm(GetParam());
  KDL::Tree tree;
  KDL::Chain kdl;
  ASSERT_TRUE(kdl_parser::treeFromString(arm_urdf(GetParam()), tree));
  ASSERT_TRUE(tree.getChain("base", "tip", kdl));
  KDL::ChainFkSolverPos_recursive forward(kdl);
  KDL::ChainJntToJacSolver jacobian(kdl);
  Draw draw(1);
  for (int i = 0; i < 20; ++i) {
    const JointVector q = draw.joints(chain);
    KDL::JntArray joints(static_cast<unsigned>(q.size()));
    joints.data = q;
    KDL::Frame frame;
    KDL::Jacobian j(static_cast<unsigned>(q.size()));
    ASSERT_GE(forward.JntToCart(joints, frame), 0);
    ASSERT_GE(jacobian.JntToJac(joints, j), 0);
    const Placement placement = chain.placement(q);
    for (int r = 0; r < 3; ++r) {
      EXPECT_NEAR(placement.tip.translation()[r], frame.p(r), 1e-12);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(placement.tip.linear()(r, c), frame.M(r, c), 1e-12);
    }
    EXPECT_LT((placement.jacobian - j.data).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_P(AnyArm, SolvesReachablePosesWithinLimitsFromAfar) {
  const ChainKinematics chain = arm(GetParam());
  Draw draw(2);
  const JointVector seed = JointVector::Constant(GetParam(), 0.05);
  int solved = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Isometry3d pose = chain.forward(draw.joints(chain));
    const IkResult result = chain.inverse(pose, seed, {7});
    if (!result.solved) continue;
    ++solved;
    expect_within_limits(chain, result.q);
    const PoseError error = error_between(chain.forward(result.q), pose, chain.task());
    EXPECT_LT(error.position, 1e-9);
    EXPECT_LT(error.orientation, 1e-9);
  }
  EXPECT_GE(solved, 498);
}

TEST_P(AnyArm, StaysNearANearSeed) {
  const ChainKinematics chain = arm(GetParam());
  Draw draw(3);
  int far = 0;
  for (int i = 0; i < 200; ++i) {
    const JointVector q = 0.8 * draw.joints(chain);
    const JointVector seed = (q.array() + 0.01).matrix();
    const IkResult result = chain.inverse(chain.forward(q), seed, {1});
    if (!result.solved || (result.q - seed).norm() > 0.2) ++far;
  }
  EXPECT_LE(far, 4) << "singular places alone";
}

TEST_P(AnyArm, GivesTheSameForTheSameDraws) {
  const ChainKinematics chain = arm(GetParam());
  Draw draw(4);
  const Eigen::Isometry3d pose = chain.forward(draw.joints(chain));
  const JointVector seed = draw.joints(chain);
  EXPECT_EQ(chain.inverse(pose, seed, {5}).q, chain.inverse(pose, seed, {5}).q);
}

TEST_P(AnyArm, OutOfReachIsNotSolvedAndTheNearestPoseIsALocalMinimum) {
  const ChainKinematics chain = arm(GetParam());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << 3.0, 0.5, 0.4;
  const JointVector seed = JointVector::Constant(GetParam(), 0.05);
  const IkResult result = chain.inverse(pose, seed, {1});
  EXPECT_FALSE(result.solved);
  EXPECT_EQ(result.q, seed);

  const double weight = 0.2;
  const auto cost = [&](const JointVector& q) {
    const PoseError error = error_between(chain.forward(q), pose, chain.task());
    return std::pow(error.position, 2) + std::pow(weight * error.orientation, 2);
  };
  const JointVector nearest = chain.nearest(pose, seed, weight);
  expect_within_limits(chain, nearest);
  EXPECT_LT(cost(nearest), cost(seed));
  for (Eigen::Index i = 0; i < seed.size(); ++i) {
    for (double step : {-1e-3, 1e-3}) {
      JointVector other = nearest;
      other[i] += step;
      other = other.cwiseMax(chain.limits().lower).cwiseMin(chain.limits().upper);
      EXPECT_GE(cost(other), cost(nearest) - 1e-9) << "joint " << i;
    }
  }
}

TEST_P(AnyArm, SelfMotionLeavesTheTaskAlone) {
  const ChainKinematics chain = arm(GetParam());
  const JointVector q = JointVector::LinSpaced(GetParam(), 0.3, 0.9);
  const JointVector wanted = JointVector::LinSpaced(GetParam(), 1e-4, -1e-4);
  const JointVector motion = chain.self_motion(q, wanted);
  const PoseError error = error_between(chain.forward(q + motion), chain.forward(q), chain.task());
  EXPECT_LT(error.position, 1e-7);
  EXPECT_LT(error.orientation, 1e-7);
  if (GetParam() >= 7) {
    EXPECT_GT(motion.dot(wanted), 1e-10);
  } else {
    EXPECT_EQ(motion, JointVector::Zero(GetParam()));
  }
}

TEST(ChainKinematics, FiveJointsFollowPositionAndAxis) {
  const ChainKinematics chain = arm(5);
  EXPECT_EQ(chain.task(), Task::kPositionAndAxis);
  EXPECT_EQ(arm(6).task(), Task::kPose);
  const JointVector q = JointVector::LinSpaced(5, 0.3, 0.9);
  Eigen::Isometry3d pose = chain.forward(q);
  pose.rotate(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(chain.inverse(pose, q, {1}).solved)
      << "a turn about the tip's z axis asks for nothing";
  pose.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  EXPECT_GT(error_between(chain.forward(q), pose, chain.task()).orientation, 0.09);
}

// Fault 45: numbers that are not finite, or joints of another arm -> refused
TEST(ChainKinematics, RefusesInputThatMeansNothing) {
  const ChainKinematics chain = arm(6);
  const JointVector q = JointVector::Zero(6);
  const Eigen::Isometry3d bad(Eigen::Matrix4d::Constant(NAN));
  EXPECT_THROW((void)chain.inverse(bad, q, {1}), std::invalid_argument);
  EXPECT_THROW((void)chain.forward(JointVector::Constant(6, INFINITY)), std::invalid_argument);
  EXPECT_THROW((void)chain.forward(JointVector::Zero(7)), std::invalid_argument);
  EXPECT_THROW((void)chain.nearest(chain.forward(q), q, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace arm_kinematics
