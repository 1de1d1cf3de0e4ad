// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <map>
#include <string>

namespace jaco_v60_description {
namespace {

class Urdf : public testing::Test {
 protected:
  void SetUp() override {
    model_ = urdf::parseURDFFile(URDF_FILE);
    ASSERT_TRUE(model_);
    ASSERT_TRUE(kdl_parser::treeFromUrdfModel(*model_, tree_));
  }

  // Frame of `tip` in `base` with the named joints at the given angles, the others at 0.
  KDL::Frame frame(const std::string& base, const std::string& tip,
                   const std::map<std::string, double>& angles = {}) const {
    KDL::Chain chain;
    EXPECT_TRUE(tree_.getChain(base, tip, chain)) << base << " to " << tip;
    KDL::JntArray joints(chain.getNrOfJoints());
    unsigned index = 0;
    for (const KDL::Segment& segment : chain.segments) {
      if (segment.getJoint().getType() == KDL::Joint::None) continue;
      const auto angle = angles.find(segment.getJoint().getName());
      joints(index++) = angle == angles.end() ? 0.0 : angle->second;
    }
    KDL::Frame result;
    EXPECT_GE(KDL::ChainFkSolverPos_recursive(chain).JntToCart(joints, result), 0);
    return result;
  }

  double mass(const std::string& prefix) const {
    double sum = 0.0;
    for (const auto& [name, link] : model_->links_) {
      if (name.rfind(prefix, 0) == 0 && link->inertial) sum += link->inertial->mass;
    }
    return sum;
  }

  urdf::ModelInterfaceSharedPtr model_;
  KDL::Tree tree_;
};

TEST_F(Urdf, HasARootWithoutInertia) {
  EXPECT_EQ(model_->getRoot()->name, "base_link");
  EXPECT_FALSE(model_->getRoot()->inertial);
}

TEST_F(Urdf, HasInertiasThatABodyCanHave) {
  int bodies = 0;
  for (const auto& [name, link] : model_->links_) {
    if (!link->inertial) continue;
    ++bodies;
    const urdf::Inertial& inertial = *link->inertial;
    EXPECT_GT(inertial.mass, 0.0) << name;
    Eigen::Matrix3d inertia;
    inertia << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy, inertial.iyz,
        inertial.ixz, inertial.iyz, inertial.izz;
    const Eigen::Vector3d moments = inertia.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GT(moments[0], 0.0) << name;
    EXPECT_GE(moments[0] + moments[1], moments[2]) << name;
  }
  EXPECT_EQ(bodies, 33);
}

TEST_F(Urdf, WeighsWhatTheDataSheetsSay) {
  EXPECT_NEAR(mass("j2s7s300_link"), 5.557, 0.001);
  EXPECT_NEAR(mass("") - mass("j2s7s300_link") - mass("mount_plate") - mass("camera"), 51.0, 1e-9);
}

TEST_F(Urdf, HasAShapeWhereverThereIsMass) {
  for (const auto& [name, link] : model_->links_) {
    EXPECT_EQ(bool(link->inertial), bool(link->collision)) << name;
    EXPECT_EQ(bool(link->visual), bool(link->collision)) << name;
  }
}

TEST_F(Urdf, HasTwelveLimitedLegJointsAndSevenOfTheArm) {
  int moving = 0;
  for (const auto& [name, joint] : model_->joints_) {
    if (joint->type == urdf::Joint::FIXED) continue;
    ++moving;
    ASSERT_TRUE(joint->limits) << name;
    EXPECT_GT(joint->limits->effort, 0.0) << name;
    EXPECT_GT(joint->limits->velocity, 0.0) << name;
    if (joint->type == urdf::Joint::REVOLUTE) {
      EXPECT_LT(joint->limits->lower, joint->limits->upper) << name;
    }
  }
  EXPECT_EQ(moving, 19);
}

// The standing robot's measured joint angles and toes; hips are nominal, hence millimetres.
TEST_F(Urdf, StandsOnTheMeasuredToes) {
  const std::map<std::string, std::pair<double, double>> corners = {
      {"fl", {1.0, 1.0}}, {"fr", {1.0, -1.0}}, {"rl", {-1.0, 1.0}}, {"rr", {-1.0, -1.0}}};
  for (const auto& [leg, corner] : corners) {
    const KDL::Frame toe = frame("base_link", leg + "_toe",
                                 {{leg + "_abduction", -0.104 * corner.second},
                                  {leg + "_hip", 0.828},
                                  {leg + "_knee", 1.657}});
    EXPECT_NEAR(toe.p.x(), 0.31 * corner.first, 1e-3) << leg;
    EXPECT_NEAR(toe.p.y(), 0.17 * corner.second, 1e-3) << leg;
    EXPECT_NEAR(toe.p.z(), -0.506, 1e-3) << leg;
  }
}

TEST_F(Urdf, CarriesTheArmOnTheBodysTop) {
  const KDL::Frame arm = frame("base_link", "j2s7s300_link_base");
  EXPECT_TRUE(KDL::Equal(arm, KDL::Frame(KDL::Vector(0.25, 0.0, 0.115)), 1e-12));
}

TEST_F(Urdf, CarriesTheCameraOnTheHand) {
  const KDL::Frame optical = frame("j2s7s300_end_effector", "camera_optical_frame");
  const KDL::Frame expected(KDL::Rotation::RotZ(M_PI), KDL::Vector(0.0, 0.07, -0.12));
  EXPECT_TRUE(KDL::Equal(optical, expected, 1e-12));

  // x of camera_link is z of the optical frame, z is its -y.
  const KDL::Frame body = frame("camera_optical_frame", "camera_link");
  EXPECT_TRUE(KDL::Equal(body.M.UnitX(), KDL::Vector(0.0, 0.0, 1.0), 1e-12));
  EXPECT_TRUE(KDL::Equal(body.M.UnitZ(), KDL::Vector(0.0, -1.0, 0.0), 1e-12));
}

TEST_F(Urdf, OpensTheFingersInsideTheBox) {
  for (int finger = 1; finger <= 3; ++finger) {
    const std::string link = "j2s7s300_link_finger_tip_" + std::to_string(finger);
    const KDL::Vector tip = frame("j2s7s300_end_effector", link) * KDL::Vector(0.041, 0.0, 0.0) +
                            KDL::Vector(0.0, 0.0, 0.006);
    EXPECT_NEAR(tip.z(), 0.03, 0.002) << "0.15 m in front of the camera";
    EXPECT_LT(std::hypot(tip.x(), tip.y()), 0.1) << "half the box is 0.15 m";
  }
}

}  // namespace
}  // namespace jaco_v60_description
