// SPDX-License-Identifier: BSD-3-Clause
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <prf_core/quoted.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "arm_kinematics/chain.hpp"

namespace arm_kinematics {
namespace {

using Joints = std::vector<urdf::JointConstSharedPtr>;  // from base to tip, fixed ones too

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text << "URDF: ";
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

std::string named(const std::string& kind, const std::string& name) {
  return kind + " " + prf_core::quoted(name);
}

urdf::ModelInterfaceSharedPtr parsed(const std::string& urdf) {
  try {
    if (auto model = urdf::parseURDF(urdf)) return model;
  } catch (const std::exception& error) {
    refuse("cannot be read (", error.what(), "), must be a <robot> whose joints form a tree");
  }
  refuse("cannot be read, must be a <robot> whose joints form a tree from one root link");
}

// The parser lets the last of several joints win.
void refuse_loops(const urdf::ModelInterface& model) {
  std::set<std::string> carried;
  for (const auto& [name, joint] : model.joints_) {
    if (carried.insert(joint->child_link_name).second) continue;
    refuse(named("link", joint->child_link_name), " is carried by two joints, ",
           prf_core::quoted(name), " is one; must be by one: a loop has no serial chain");
  }
}

Joints joints_between(const urdf::ModelInterface& model, const std::string& base,
                      const std::string& tip) {
  for (const std::string& link : {base, tip}) {
    if (!model.getLink(link)) refuse("has no ", named("link", link), ", must be a link of it");
  }
  Joints joints;
  for (auto link = model.getLink(tip); link->name != base; link = link->getParent()) {
    if (!link->parent_joint) {
      refuse(named("link", tip), " is not carried by ", named("link", base), ", must be");
    }
    joints.push_back(link->parent_joint);
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

Eigen::Isometry3d pose_of(const urdf::Pose& pose) {
  Eigen::Quaterniond turn;
  pose.rotation.getQuaternion(turn.x(), turn.y(), turn.z(), turn.w());
  const Eigen::Vector3d place(pose.position.x, pose.position.y, pose.position.z);
  if (!place.allFinite() || !turn.coeffs().allFinite())
    return Eigen::Isometry3d(NAN * Eigen::Matrix4d::Ones());
  return Eigen::Translation3d(place) * turn.normalized();
}

void require_moving_kind(const urdf::Joint& joint) {
  const bool follows = joint.type == urdf::Joint::REVOLUTE ||
                       joint.type == urdf::Joint::CONTINUOUS ||
                       joint.type == urdf::Joint::PRISMATIC;
  if (!follows) {
    refuse(named("joint", joint.name),
           " is floating or planar, must be revolute, continuous, prismatic or fixed");
  }
  if (joint.mimic) {
    refuse(named("joint", joint.name), " mimics ", prf_core::quoted(joint.mimic->joint_name),
           ", must move on its own between base and tip");
  }
}

void set_limits(const urdf::Joint& joint, Eigen::Index i, JointLimits* limits) {
  const auto bad = [&](const char* what, double value, const char* must) {
    refuse(what, " of ", named("joint", joint.name), " = ", value, ", must be ", must);
  };
  if (!joint.limits) {
    refuse(named("joint", joint.name), " has no <limit>, must have velocity",
           joint.type == urdf::Joint::CONTINUOUS ? "" : ", lower and upper");
  }
  const urdf::JointLimits& given = *joint.limits;
  if (!(given.velocity > 0.0 && std::isfinite(given.velocity))) {
    bad("velocity limit", given.velocity, "finite and > 0");
  }
  limits->velocity[i] = given.velocity;
  limits->effort[i] = given.effort;
  const double infinity = std::numeric_limits<double>::infinity();
  limits->lower[i] = -infinity;
  limits->upper[i] = infinity;
  limits->acceleration[i] = infinity;
  if (joint.type == urdf::Joint::CONTINUOUS) return;
  if (!std::isfinite(given.lower)) bad("lower limit", given.lower, "finite");
  if (!std::isfinite(given.upper)) bad("upper limit", given.upper, "finite");
  if (!(given.lower < given.upper)) {
    std::ostringstream must;
    must << "above the lower limit " << given.lower;
    bad("upper limit", given.upper, must.str().c_str());
  }
  limits->lower[i] = given.lower;
  limits->upper[i] = given.upper;
}

// The rotation that takes z to the joint's axis.
Eigen::Quaterniond axis_frame(const urdf::Joint& joint) {
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(axis.norm() > 1e-6)) {
    refuse("axis of ", named("joint", joint.name), " has no direction, must be a unit vector");
  }
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis.normalized());
}

}  // namespace

Chain chain_from_urdf(const std::string& urdf, const std::string& base, const std::string& tip) {
  const auto model = parsed(urdf);
  refuse_loops(*model);
  const Joints joints = joints_between(*model, base, tip);
  const auto count = std::count_if(joints.begin(), joints.end(), [](const auto& joint) {
    return joint->type != urdf::Joint::FIXED;
  });
  if (count < 5 || count > kMaxJoints) {
    refuse(count, " joints move between ", named("link", base), " and ", named("link", tip),
           ", must be 5 to ", kMaxJoints);
  }

  Chain chain;
  for (JointVector* values : {&chain.limits.lower, &chain.limits.upper, &chain.limits.velocity,
                              &chain.limits.effort, &chain.limits.acceleration}) {
    values->resize(count);
  }
  Eigen::Isometry3d pending = Eigen::Isometry3d::Identity();
  for (const auto& joint : joints) {
    pending = pending * pose_of(joint->parent_to_joint_origin_transform);
    if (!pending.matrix().allFinite()) {
      refuse("origin of ", named("joint", joint->name), " is not finite, must be");
    }
    if (joint->type == urdf::Joint::FIXED) continue;
    require_moving_kind(*joint);
    set_limits(*joint, static_cast<Eigen::Index>(chain.joints.size()), &chain.limits);
    const Eigen::Quaterniond frame = axis_frame(*joint);
    chain.joints.push_back({joint->name, joint->type == urdf::Joint::PRISMATIC, pending * frame});
    pending = Eigen::Isometry3d(frame.inverse());
  }
  chain.tip = pending;
  return chain;
}

}  // namespace arm_kinematics
