// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "camera_sim/target_box.hpp"
#include "platform_sim/contacts.hpp"
#include "platform_sim/disturbances.hpp"
#include "platform_sim/frame_state.hpp"
#include "platform_sim/world_params.hpp"

namespace platform_sim {

/// Joints in the order of World::joint_names(): 12 of the legs, if there are any, then the arm's.
struct JointStates {
  Eigen::VectorXd positions;   ///< rad
  Eigen::VectorXd velocities;  ///< rad/s
  Eigen::VectorXd efforts;     ///< Nm, torque of the motor
};

/// Rigid-body world: a robot from a URDF stands on a kinematic platform before an
/// open box, which the platform or a cart carries or which stands ashore. Deterministic: two worlds
/// built alike and stepped alike are bitwise equal. A robot on legs has
/// the joints of v60_gait::leg_joint_names(); another one is bolted to the platform with its first
/// link. At time 0 the robot has settled for 2 s on the platform, which is still at rest.
class World {
 public:
  /// Length of a physics step, s.
  static constexpr double kTimeStep = 0.001;

  /// Throws std::invalid_argument for a robot description that cannot be simulated or for
  /// parameters that WorldParams::validate() refuses.
  World(const std::string& urdf_xml, const WorldParams& config);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  [[nodiscard]] static const std::vector<std::string>& gait_names();

  /// Advances by kTimeStep.
  void step();
  [[nodiscard]] double time() const;

  [[nodiscard]] const std::vector<std::string>& joint_names() const;
  [[nodiscard]] JointStates joints() const;
  /// State of any link of the robot description, frames without mass included, in world.
  /// Throws std::invalid_argument if there is no such link.
  [[nodiscard]] FrameState frame(const std::string& link) const;
  [[nodiscard]] const RobotParts& robot() const;
  [[nodiscard]] const std::string& base_link() const;  ///< the robot's first link
  [[nodiscard]] FrameState base() const;               ///< frame(base_link())
  [[nodiscard]] FrameState platform() const;
  [[nodiscard]] FrameState carrier()
      const;  ///< of the box: platform(), the cart, or the shore, which rests
  [[nodiscard]] FrameState tag() const;
  [[nodiscard]] const camera_sim::TargetBox& target() const;

  [[nodiscard]] const Disturbances& disturbances() const;

  /// Contacts since the last call, one per pair of links, in alphabetical order.
  [[nodiscard]] std::vector<Contact> take_contacts();
  /// By the criterion of prf_msgs/interfaces.yaml, as the judge has it: the body is low, tilted or
  /// touches the platform. Always false if the base is carried.
  [[nodiscard]] bool fallen() const;

  /// ArmMode::kServo without a driver only, else std::invalid_argument. Queues a set-point of the
  /// arm: it waits for arm_latency at least, one is taken every 10 ms, and it is held until the
  /// next one is taken. The velocity is a feed-forward that lapses 20 ms later, so that an arm
  /// without commands comes to rest.
  void command_arm(const ArmVector& positions, const ArmVector& velocities);
  /// With WorldParams::driver only, else std::invalid_argument. Sends the driver a message; what is
  /// not finite throws, too.
  void command_driver(const DriverPoint& point);
  /// The same. Forgets what waits and brings the arm to rest where it is.
  void halt_driver();
  /// ArmMode::kCompliant only, else std::invalid_argument. Force, N, at the origin of
  /// the hand's link and torque, Nm, on the hand, in world axes, held until the next call.
  void apply_hand_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque);
  /// A disturbance: force, N, in world axes, at the origin of a link during the next step only;
  /// several before one step add up. Throws std::invalid_argument if there is no such link or the
  /// force is not finite.
  void push(const std::string& link, const Eigen::Vector3d& force);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace platform_sim
