// SPDX-License-Identifier: BSD-3-Clause
#include "robot_description.hpp"

#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <sstream>
#include <stdexcept>

namespace prf_control {
namespace {

using jaco_kinematics::JointVector;
using Chain = std::vector<urdf::JointConstSharedPtr>;  // from base to hand, fixed joints too

constexpr double kAngle = 1e-3;      // rad, rad/s
constexpr double kPosition = 1e-4;   // m
constexpr int kConfigurations = 10;  // in which axes and hand are compared

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  text << "robot_description does not fit the kinematics of the Jaco2 (j2s7s300): ";
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

bool is_moving(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return "[" + text + "]";
}

urdf::ModelInterfaceSharedPtr parsed(const std::string& urdf) {
  try {
    if (auto model = urdf::parseURDF(urdf)) return model;
  } catch (const std::exception& error) {
    refuse("it is no valid URDF (", error.what(), ")");
  }
  refuse("it is no valid URDF");
}

Chain chain_of(const urdf::ModelInterface& model, const ArmNames& names) {
  for (const std::string& link : {names.base, names.hand}) {
    if (!model.getLink(link)) refuse("it has no link ", link);
  }
  Chain chain;
  for (auto link = model.getLink(names.hand); link->name != names.base; link = link->getParent()) {
    if (!link->parent_joint) refuse("link ", names.hand, " is not carried by ", names.base);
    chain.push_back(link->parent_joint);
  }
  std::reverse(chain.begin(), chain.end());
  std::vector<std::string> moving;
  for (const auto& joint : chain) {
    if (is_moving(*joint)) moving.push_back(joint->name);
  }
  if (moving != names.joints) {
    refuse("its joints from ", names.base, " to ", names.hand, " are ", listed(moving), ", not ",
           listed(names.joints));
  }
  return chain;
}

void require_near(const std::string& what, double value, double expected) {
  if (std::abs(value - expected) <= kAngle) return;  // false for not-a-number
  refuse(what, " is ", value, ", not ", expected);
}

void compare_limits(const urdf::Joint& joint, int i) {
  const auto& limits = jaco_kinematics::jaco_joint_limits();
  const bool continuous = std::isinf(limits.upper[i]);
  const auto type = continuous ? urdf::Joint::CONTINUOUS : urdf::Joint::REVOLUTE;
  if (joint.type != type) refuse(joint.name, " is not ", continuous ? "continuous" : "revolute");
  if (joint.mimic) refuse(joint.name, " mimics another joint");
  if (!joint.limits && continuous) return;
  if (!joint.limits) refuse(joint.name, " has no limits");
  require_near("velocity limit of " + joint.name, joint.limits->velocity, limits.velocity[i]);
  if (continuous) return;
  require_near("lower limit of " + joint.name, joint.limits->lower, limits.lower[i]);
  require_near("upper limit of " + joint.name, joint.limits->upper, limits.upper[i]);
}

struct Placed {
  Eigen::Isometry3d hand;
  std::vector<Eigen::Vector3d> axes;  // unit, in the base
};

Placed placed(const Chain& chain, const JointVector& q) {
  Placed result{Eigen::Isometry3d::Identity(), {}};
  for (const auto& joint : chain) {
    const urdf::Pose& origin = joint->parent_to_joint_origin_transform;
    Eigen::Quaterniond turn;
    origin.rotation.getQuaternion(turn.x(), turn.y(), turn.z(), turn.w());
    result.hand.translate(Eigen::Vector3d(origin.position.x, origin.position.y, origin.position.z));
    result.hand.rotate(turn);
    if (!is_moving(*joint)) continue;
    const auto axis = Eigen::Vector3d(joint->axis.x, joint->axis.y, joint->axis.z).normalized();
    const auto i = static_cast<Eigen::Index>(result.axes.size());
    result.axes.push_back(result.hand.linear() * axis);
    result.hand.rotate(Eigen::AngleAxisd(q[i], axis));
  }
  return result;
}

// Spread over the turn of each joint, each joint in its own order.
JointVector configuration(int number) {
  JointVector q;
  for (int i = 0; i < q.size(); ++i) {
    q[i] = 2.0 * M_PI * std::fmod((number + 0.5) * 0.618 * (i + 1), 1.0);
  }
  return q;
}

void compare_motion(const Chain& chain, const ArmNames& names, const JointVector& q) {
  const Placed robot = placed(chain, q);
  const auto jacobian = jaco_kinematics::jacobian(q);
  for (int i = 0; i < q.size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const double difference = (robot.axes[joint] - jacobian.col(i).tail<3>()).norm();
    if (difference <= kAngle) continue;
    refuse("the axis of ", names.joints[joint], " differs by ", difference,
           " rad with the joints at (", q.transpose(), ") rad");
  }
  const Eigen::Isometry3d error = robot.hand.inverse() * jaco_kinematics::forward(q);
  const double distance = error.translation().norm();
  const double angle = Eigen::AngleAxisd(error.linear()).angle();
  if (distance <= kPosition && angle <= kAngle) return;
  refuse(names.hand, " is ", distance, " m and ", angle, " rad from where it should be in ",
         names.base, " with the joints at (", q.transpose(), ") rad");
}

}  // namespace

void require_same_arm(const std::string& urdf, const ArmNames& names) {
  const auto model = parsed(urdf);
  const Chain chain = chain_of(*model, names);
  int i = 0;
  for (const auto& joint : chain) {
    if (is_moving(*joint)) compare_limits(*joint, i++);
  }
  for (int number = 0; number < kConfigurations; ++number) {
    compare_motion(chain, names, configuration(number));
  }
}

std::string wait_for_robot_description(const ros::NodeHandle& node, double patience) {
  const ros::WallTime limit = ros::WallTime::now() + ros::WallDuration(patience);
  std::string key;
  std::string urdf;
  while (ros::ok()) {
    if (node.searchParam("robot_description", key) && node.getParam(key, urdf)) return urdf;
    if (ros::WallTime::now() > limit) break;
    ros::WallDuration(0.1).sleep();
  }
  std::ostringstream text;
  text << "robot_description missing after " << patience
       << " s, must be the URDF of the robot: it is compared with the kinematics before anything "
          "moves (roslaunch jaco_v60_description description.launch)";
  throw std::invalid_argument(text.str());
}

}  // namespace prf_control
