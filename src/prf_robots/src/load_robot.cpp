// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <arm_kinematics/chain_kinematics.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <jaco_kinematics/jaco_arm.hpp>
#include <prf_core/bounds.hpp>
#include <prf_core/quoted.hpp>
#include <prf_core/readable_file.hpp>
#include <sstream>
#include <stdexcept>

#include "prf_robots/robot.hpp"

namespace prf_robots {
namespace {

using arm_kinematics::Chain;
using arm_kinematics::ChainKinematics;
using prf_core::quoted;

constexpr const char* kKeys[] = {"acceleration",  "base",  "base_link", "camera_frame",
                                 "driver_period", "jerk",  "joints",    "kinematics",
                                 "reach",         "ready", "shoulder",  "tip_link"};
constexpr double kMaxJerk = 1e6;     // rad/s^3
constexpr double kShortest = 0.002;  // s, of the driver's period
constexpr double kLongest = 0.025;
// m, rad: the closed form and the URDF are one arm.
constexpr double kSameArm = 1e-4;
constexpr int kConfigurations = 10;

// The values of robot.yaml.
class Keys {
 public:
  explicit Keys(const std::string& file) : file_(file) {
    prf_core::require_readable_file(file);
    try {
      root_ = YAML::LoadFile(file);
    } catch (const YAML::Exception& error) {
      throw std::invalid_argument(file + ": no YAML (" + error.what() + ")");
    }
    if (!root_.IsMap()) throw std::invalid_argument(file + ": must be keys with values");
    for (const auto& entry : root_) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (std::find(std::begin(kKeys), std::end(kKeys), key) != std::end(kKeys)) continue;
      std::string known;
      for (const char* name : kKeys) known += (known.empty() ? "" : ", ") + std::string(name);
      throw std::invalid_argument(file_ + ": unknown key " + quoted(key) + ", must be one of " +
                                  known);
    }
  }

  [[nodiscard]] bool has(const char* key) const { return root_[key].IsDefined(); }

  [[noreturn]] void refuse(const char* key, const std::string& value,
                           const std::string& must) const {
    throw std::invalid_argument(file_ + ": " + key + " = " + value + ", must be " + must);
  }

  [[nodiscard]] std::string text(const char* key) const {
    const YAML::Node node = node_of(key);
    if (!node.IsScalar() || node.Scalar().empty()) refuse(key, shown(node), "a name");
    return node.Scalar();
  }

  [[nodiscard]] double number(const char* key, double low, double high) const {
    return number(key, node_of(key), low, high);
  }

  [[nodiscard]] std::vector<std::string> texts(const char* key) const {
    const YAML::Node node = node_of(key);
    if (!node.IsSequence()) refuse(key, shown(node), "a list of names");
    std::vector<std::string> result;
    for (const auto& item : node) {
      if (!item.IsScalar()) refuse(key, shown(node), "a list of names");
      result.push_back(item.Scalar());
    }
    return result;
  }

  [[nodiscard]] JointVector numbers(const char* key, std::size_t count, double low,
                                    double high) const {
    const YAML::Node node = node_of(key);
    if (!node.IsSequence() || node.size() != count) {
      refuse(key, shown(node), "a list of " + std::to_string(count) + " numbers");
    }
    JointVector result(static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      result[static_cast<Eigen::Index>(i)] = number(key, node[i], low, high);
    }
    return result;
  }

 private:
  [[nodiscard]] YAML::Node node_of(const char* key) const {
    if (has(key)) return root_[key];
    throw std::invalid_argument(file_ + ": key " + key + " missing");
  }

  static std::string shown(const YAML::Node& node) {
    YAML::Emitter out;
    out << YAML::Flow << node;
    return quoted(std::string(out.c_str()));
  }

  [[nodiscard]] double number(const char* key, const YAML::Node& node, double low,
                              double high) const {
    double value = NAN;
    if (node.IsScalar()) YAML::convert<double>::decode(node, value);
    if (value >= low && value <= high) return value;
    std::ostringstream must;
    must << "a number within [" << low << ", " << high << "]";
    refuse(key, shown(node), must.str());
  }

  std::string file_;
  YAML::Node root_;
};

std::string content(const std::string& file) {
  prf_core::require_readable_file(file);
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return "[" + text + "]";
}

std::vector<std::string> names_of(const Chain& chain) {
  std::vector<std::string> names;
  for (const auto& joint : chain.joints) names.push_back(joint.name);
  return names;
}

Chain chain_of(const Robot& robot, const std::string& file) {
  try {
    return arm_kinematics::chain_from_urdf(robot.urdf, robot.base_link, robot.tip_link);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(file + ": " + error.what());
  }
}

void require_camera_on_hand(const Robot& robot, const Keys& keys) {
  std::vector<std::string> joints;
  try {
    joints =
        names_of(arm_kinematics::chain_from_urdf(robot.urdf, robot.base_link, robot.camera_frame));
  } catch (const std::invalid_argument&) {
    // No link, or fewer joints: not on the hand.
  }
  if (joints == robot.joints) return;
  keys.refuse("camera_frame", quoted(robot.camera_frame),
              "a link that " + robot.joints.back() + " carries");
}

void require_ready_within(const Robot& robot, const Keys& keys, const Chain& chain) {
  for (Eigen::Index i = 0; i < robot.ready.size(); ++i) {
    if (robot.ready[i] >= chain.limits.lower[i] && robot.ready[i] <= chain.limits.upper[i])
      continue;
    std::ostringstream must;
    must << "within the limits [" << chain.limits.lower[i] << ", " << chain.limits.upper[i]
         << "] of " << chain.joints[static_cast<std::size_t>(i)].name;
    keys.refuse("ready", std::to_string(robot.ready[i]), must.str());
  }
}

// A closed form is for one arm alone.
void require_same_arm(const arm_kinematics::ArmKinematics& closed_form,
                      const ChainKinematics& chain, const Keys& keys) {
  const auto refuse = [&](const char* what) {
    keys.refuse("kinematics", "jaco2",
                std::string("chain: ") + what + " of the URDF are not those of this closed form");
  };
  if (chain.joint_count() != closed_form.joint_count()) refuse("the joints");
  const auto differ = [](const JointVector& a, const JointVector& b) {
    return (a.array() != b.array() && !((a - b).array().abs() < kSameArm)).any();
  };
  if (differ(chain.limits().lower, closed_form.limits().lower) ||
      differ(chain.limits().upper, closed_form.limits().upper)) {
    refuse("the limits");
  }
  JointVector q(chain.joint_count());
  for (int number = 0; number < kConfigurations; ++number) {
    for (int i = 0; i < q.size(); ++i) {  // spread over the turn, each joint in its own order
      q[i] = 2.0 * M_PI * std::fmod((number + 0.5) * 0.618 * (i + 1), 1.0);
    }
    const auto error = arm_kinematics::error_between(chain.forward(q), closed_form.forward(q),
                                                     arm_kinematics::Task::kPose);
    if (!(error.position < kSameArm && error.orientation < kSameArm)) refuse("the lengths or axes");
  }
}

}  // namespace

Robot load_robot(const std::string& folder) {
  const std::string file = folder + "/robot.yaml";
  const std::string urdf_file = folder + "/robot.urdf";
  const Keys keys(file);
  Robot robot;
  robot.folder = folder;
  const std::string base = keys.text("base");
  if (base != "legs" && base != "deck") keys.refuse("base", quoted(base), "legs or deck");
  robot.on_legs = base == "legs";
  robot.base_link = keys.text("base_link");
  robot.tip_link = keys.text("tip_link");
  robot.camera_frame = keys.text("camera_frame");
  robot.joints = keys.texts("joints");
  robot.driver_period = keys.number("driver_period", kShortest, kLongest);
  robot.urdf = content(urdf_file);

  Chain chain = chain_of(robot, urdf_file);
  const std::vector<std::string> joints = names_of(chain);
  if (robot.joints != joints) {
    keys.refuse("joints", listed(robot.joints),
                listed(joints) + ", which " + urdf_file + " has from " + robot.base_link + " to " +
                    robot.tip_link);
  }
  require_camera_on_hand(robot, keys);
  const std::size_t count = joints.size();
  robot.ready =
      keys.numbers("ready", count, -prf_core::kMaxJointPosition, prf_core::kMaxJointPosition);
  require_ready_within(robot, keys, chain);
  robot.shoulder = keys.numbers("shoulder", 3, -2.0, 2.0);
  robot.reach = keys.number("reach", 0.1, 2.0);
  if (keys.has("acceleration")) {
    chain.limits.acceleration =
        keys.numbers("acceleration", count, 1e-3, prf_core::kMaxAcceleration);
  }
  if (keys.has("jerk")) robot.jerk = keys.numbers("jerk", count, 1e-3, kMaxJerk);

  const std::string kinematics = keys.has("kinematics") ? keys.text("kinematics") : "chain";
  const auto of_urdf = std::make_shared<ChainKinematics>(std::move(chain));
  if (kinematics == "chain") {
    robot.kinematics = of_urdf;
  } else if (kinematics == "jaco2") {
    robot.kinematics = std::make_shared<jaco_kinematics::JacoArm>();
    require_same_arm(*robot.kinematics, *of_urdf, keys);
  } else {
    keys.refuse("kinematics", quoted(kinematics), "chain or jaco2");
  }
  return robot;
}

}  // namespace prf_robots
