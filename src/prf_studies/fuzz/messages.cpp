// SPDX-License-Identifier: BSD-3-Clause
// What decision, predictor and simulator take from messages.
#include <tf2_msgs/TFMessage.h>

#include <prf_msgs/TagDetection.h>

#include <prf_ros/conversions.hpp>
#include <tuple>

#include "../../platform_sim/node/conversions.hpp"
#include "../../prf_decision/node/conversions.hpp"
#include "fuzz_target.hpp"
#include "prf_predictor/frame_chain.hpp"
#include "prf_predictor/tag_measurement.hpp"

namespace {

const prf_robots::Robot kRobot = [] {
  prf_robots::Robot robot;
  robot.base_link = "j2s7s300_link_base";
  robot.tip_link = "j2s7s300_end_effector";
  for (int i = 1; i <= 7; ++i) robot.joints.push_back("j2s7s300_joint_" + std::to_string(i));
  return robot;
}();

}  // namespace

FUZZ_TARGET(decision_messages) {
  const int kind = bytes.byte();
  fuzz::accepts([&] {
    prf_msgs::SkillTrajectory trajectory;
    prf_msgs::TargetForecast forecast;
    sensor_msgs::JointState joints;
    if (kind % 3 == 0 && fuzz::read(bytes, trajectory)) {
      const auto result = prf_decision::to_plan_result(kRobot, trajectory);
      if (!result.plan) return;
      for (const auto& pose : result.plan->poses) {
        fuzz::expect(pose.is_finite(), "an accepted plan is finite");
      }
    } else if (kind % 3 == 1 && fuzz::read(bytes, forecast)) {
      const auto accepted = prf_decision::to_core(kRobot, forecast);
      if (accepted->predictions.empty()) return;
      const auto later = accepted->stamp + std::chrono::seconds(1);
      fuzz::expect(prf_core::predicted_target(*accepted, later).target.pose.is_finite(),
                   "the target of an accepted forecast is finite");
      (void)prf_ros::to_ros_time(later);
    } else if (kind % 3 == 2 && fuzz::read(bytes, joints)) {
      const auto measured = prf_decision::measured_joints(kRobot, joints);
      fuzz::expect(!measured || measured->allFinite(), "the measured joints are finite");
    }
  });
}

FUZZ_TARGET(predictor_detection) {
  prf_msgs::TagDetection detection;
  if (!fuzz::read(bytes, detection)) return;
  using RowMajor6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  const auto& pose = detection.pose.pose;
  const auto checked = prf_predictor::check(
      prf_ros::to_core(pose.position), prf_ros::to_core(pose.orientation),
      Eigen::Map<const RowMajor6d>(detection.pose.covariance.data()), {0.01, 0.05});
  if (!checked.measurement) return;
  const auto& measurement = *checked.measurement;
  fuzz::expect(measurement.position.allFinite() && measurement.position_covariance.allFinite() &&
                   measurement.orientation_covariance.allFinite(),
               "an accepted measurement is finite");
  fuzz::expect(measurement.position_covariance.determinant() >= 0.0, "its covariance is one");
}

FUZZ_TARGET(predictor_transforms) {
  prf_predictor::FrameChain chain("base", std::chrono::milliseconds(100));
  std::vector<prf_core::Stamp> stamps = {std::chrono::seconds(1)};
  fuzz::for_each_message(bytes, [&](int kind, fuzz::Bytes part) {
    tf2_msgs::TFMessage message;
    if (!fuzz::read(part, message)) return;
    for (const auto& transform : message.transforms) {
      const auto& [translation, rotation] =
          std::tie(transform.transform.translation, transform.transform.rotation);
      stamps.push_back(prf_ros::to_core(transform.header.stamp));
      chain.add({transform.header.frame_id,
                 transform.child_frame_id,
                 stamps.back(),
                 {prf_ros::to_core(translation), prf_ros::to_core(rotation)}},
                kind % 2 == 1);
    }
  });
  for (const auto& stamp : stamps) {
    const auto found = chain.lookup("camera", stamp);
    fuzz::expect(found.readiness != prf_predictor::FrameChain::Readiness::kReady ||
                     found.camera_in_planning.matrix().allFinite(),
                 "a camera's pose is finite");
  }
}

FUZZ_TARGET(simulator_messages) {
  const bool is_wrench = bytes.byte() % 2 == 1;
  fuzz::accepts([&] {
    trajectory_msgs::JointTrajectory command;
    geometry_msgs::WrenchStamped wrench;
    if (!is_wrench && fuzz::read(bytes, command)) {
      const auto arm = platform_sim::to_arm_command(command, kRobot.joints);
      fuzz::expect(arm.positions.allFinite() && arm.velocities.allFinite(),
                   "a command of the arm is finite");
    } else if (is_wrench && fuzz::read(bytes, wrench)) {
      fuzz::expect(platform_sim::to_hand_wrench(wrench).force.allFinite(), "a force is finite");
    }
  });
}
