// SPDX-License-Identifier: BSD-3-Clause
#include "robot_description.hpp"

#include <arm_kinematics/chain_kinematics.hpp>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace prf_control {
namespace {

using arm_kinematics::Chain;
using arm_kinematics::ChainKinematics;
using arm_kinematics::JointVector;
using prf_robots::Robot;

constexpr double kAngle = 1e-3;      // rad, rad/s; m, m/s of a prismatic joint
constexpr double kPosition = 1e-4;   // m
constexpr int kConfigurations = 10;  // in which axes and tip are compared

template <typename... Parts>
[[noreturn]] void refuse(const Robot& robot, const Parts&... parts) {
  std::ostringstream text;
  text << "robot_description does not fit the robot " << robot.folder << ": ";
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return "[" + text + "]";
}

Chain chain_of(const std::string& urdf, const Robot& robot) {
  try {
    return arm_kinematics::chain_from_urdf(urdf, robot.base_link, robot.tip_link);
  } catch (const std::invalid_argument& error) {
    refuse(robot, error.what());
  }
}

void compare_names(const Chain& chain, const Robot& robot) {
  std::vector<std::string> names;
  for (const auto& joint : chain.joints) names.push_back(joint.name);
  if (names == robot.joints) return;
  refuse(robot, "its joints from ", robot.base_link, " to ", robot.tip_link, " are ", listed(names),
         ", not ", listed(robot.joints));
}

void compare_limits(const Chain& chain, const Robot& robot) {
  const auto compare = [&](const char* what, const JointVector& there, const JointVector& wanted) {
    for (Eigen::Index i = 0; i < wanted.size(); ++i) {
      // Equal infinities are near; not-a-number is not.
      if (there[i] == wanted[i] || std::abs(there[i] - wanted[i]) <= kAngle) continue;
      refuse(robot, what, " limit of ", robot.joints[static_cast<std::size_t>(i)], " is ", there[i],
             ", not ", wanted[i]);
    }
  };
  const auto& limits = robot.kinematics->limits();
  compare("lower", chain.limits.lower, limits.lower);
  compare("upper", chain.limits.upper, limits.upper);
  compare("velocity", chain.limits.velocity, limits.velocity);
}

// Spread over the turn of each joint, each joint in its own order.
JointVector configuration(int number, Eigen::Index joints) {
  JointVector q(joints);
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = 2.0 * M_PI * std::fmod((number + 0.5) * 0.618 * static_cast<double>(i + 1), 1.0);
  }
  return q;
}

void compare_motion(const ChainKinematics& chain, const Robot& robot, const JointVector& q) {
  const auto there = chain.placement(q);
  const auto wanted = robot.kinematics->placement(q);
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    // The whole column for a prismatic joint, which has no axis of rotation.
    const bool prismatic = chain.chain().joints[static_cast<std::size_t>(i)].prismatic;
    const double difference =
        prismatic ? (there.jacobian.col(i) - wanted.jacobian.col(i)).norm()
                  : (there.jacobian.col(i) - wanted.jacobian.col(i)).tail<3>().norm();
    if (difference <= kAngle) continue;
    refuse(robot, "the axis of ", robot.joints[static_cast<std::size_t>(i)], " differs by ",
           difference, " rad with the joints at (", q.transpose(), ") rad");
  }
  const auto error =
      arm_kinematics::error_between(there.tip, wanted.tip, arm_kinematics::Task::kPose);
  if (error.position <= kPosition && error.orientation <= kAngle) return;
  refuse(robot, robot.tip_link, " is ", error.position, " m and ", error.orientation,
         " rad from where it should be in ", robot.base_link, " with the joints at (",
         q.transpose(), ") rad");
}

}  // namespace

void require_same_arm(const std::string& urdf, const Robot& robot) {
  const ChainKinematics chain(chain_of(urdf, robot));
  compare_names(chain.chain(), robot);
  compare_limits(chain.chain(), robot);
  for (int number = 0; number < kConfigurations; ++number) {
    compare_motion(chain, robot, configuration(number, chain.joint_count()));
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
          "moves (roslaunch prf_robots description.launch)";
  throw std::invalid_argument(text.str());
}

}  // namespace prf_control
