// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "motion/body_motion.hpp"
#include "physics/arm_servo.hpp"
#include "physics/base_carrier.hpp"
#include "physics/driver_arm.hpp"
#include "physics/robot_bodies.hpp"
#include "platform_sim/cart_push.hpp"
#include "platform_sim/platform_motion.hpp"
#include "prf_core/require.hpp"
#include "prf_msgs/fall_criterion.h"
#include "v60_gait/gaits.hpp"
#include "v60_gait/gravity.hpp"
#include "v60_gait/leg_sensors.hpp"
#include "v60_gait/operator.hpp"
#include "v60_gait/stance.hpp"
#include "v60_gait/stiff_controller.hpp"

namespace platform_sim {
namespace {

constexpr double kSettlingTime = 2.0;  // s, until legs and contacts are at rest

std::vector<CuboidBody::Part> to_parts(const std::vector<camera_sim::Cuboid>& cuboids) {
  std::vector<CuboidBody::Part> parts;
  for (const camera_sim::Cuboid& cuboid : cuboids)
    parts.emplace_back(cuboid.pose_in_platform, cuboid.size);
  return parts;
}

}  // namespace

class World::Impl {
 public:
  Impl(const std::string& urdf_xml, const WorldParams& config);

  void step();
  void command_arm(const ArmVector& positions, const ArmVector& velocities);
  void command_driver(const DriverPoint& point);
  void halt_driver() { arm_->halt(); }
  void apply_hand_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque);
  void push(const std::string& link, const Eigen::Vector3d& force);
  [[nodiscard]] JointStates joints() const;
  [[nodiscard]] FrameState platform() const { return motion_.deck(time()); }
  [[nodiscard]] FrameState carrier() const;
  [[nodiscard]] const Disturbances& disturbances() const { return disturbances_; }
  [[nodiscard]] FrameState tag() const;

  [[nodiscard]] double time() const { return static_cast<double>(steps_) * kTimeStep; }
  [[nodiscard]] const RobotModel& robot() const { return robot_; }
  [[nodiscard]] const camera_sim::TargetBox& target() const { return target_; }
  [[nodiscard]] const std::vector<std::string>& joint_names() const { return joint_names_; }
  [[nodiscard]] const RobotParts& parts() const { return parts_; }
  [[nodiscard]] const std::string& base_link() const { return robot_.tree().bodies.front().name; }
  [[nodiscard]] bool fallen() const { return fallen_; }
  ContactRecorder contacts;

 private:
  void require_bolted(const WorldParams& config) const;
  void place_robot(const WorldParams& config);
  void settle();
  void drive_legs();
  void disturb();
  [[nodiscard]] v60_gait::LegObservation observe_legs();
  void judge_fall(const std::vector<ContactPoint>& points);
  [[nodiscard]] bool is_carried() const {
    return motion_.carries_base() || body_motion_ || !parts_.on_legs;
  }
  [[nodiscard]] Eigen::Isometry3d carried_base() const;

  RobotBodies bodies_;
  RobotParts parts_;
  PlatformMotion motion_;
  std::optional<BodyMotion> body_motion_;
  Eigen::Isometry3d base_start_ = Eigen::Isometry3d::Identity();  // in platform
  bool target_stands_ashore_;
  Disturbances disturbances_;
  std::optional<CartPush> push_;  // of a cart that no disturbance moves
  double foot_hold_ = 0.0;        // N, what friction holds at a quarter of the weight
  camera_sim::TargetBox target_;
  BulletScene scene_{kTimeStep};
  CuboidBody deck_;
  CuboidBody box_;
  CuboidBody support_;
  std::optional<CuboidBody> obstacle_;
  RobotModel robot_;
  std::vector<std::string> joint_names_;
  std::vector<const v60_gait::RobotJoint*> leg_joints_;
  std::vector<const v60_gait::RobotJoint*> arm_joints_;
  std::unique_ptr<BaseCarrier> base_carrier_;  // if is_carried()
  std::unique_ptr<v60_gait::LegController> legs_;
  v60_gait::LegSensors sensors_;
  std::optional<v60_gait::Operator> operator_;
  std::unique_ptr<ArmDrive> arm_;
  v60_gait::LegVector leg_efforts_ = v60_gait::LegVector::Zero();
  std::int64_t steps_ = 0;
  bool fallen_ = false;
};

World::Impl::Impl(const std::string& urdf_xml, const WorldParams& config)
    : bodies_(urdf_xml, config.robot.arm_joints),
      parts_(config.robot),
      motion_(config.motion, config.seed),
      body_motion_(config.body_motion.empty() ? std::nullopt
                                              : std::optional<BodyMotion>(config.body_motion)),
      target_stands_ashore_(config.target_stands_ashore()),
      disturbances_(config.disturb, config.seed),
      target_(config.placed_target()),
      deck_(scene_, "platform", to_parts({camera_sim::deck()}), {kDeck, ~kSurroundings},
            motion_.deck(0.0).pose),
      box_(scene_, "box", to_parts(target_.walls()), {kTarget, ~kSurroundings},
           motion_.deck(0.0).pose),
      support_(scene_, target_.on_cart ? "cart" : "post", to_parts(target_.support()),
               {kTarget, ~kSurroundings}, motion_.deck(0.0).pose),
      robot_(scene_, urdf_xml, RobotModel::Base::kFloating,
             [&](const std::string& body) {
               RobotSurface surface = bodies_.surface(body, config.friction);
               // A carried base is not held by contacts; the arm on a bolted one may hit the deck.
               const bool bolted = !parts_.on_legs;
               if (bolted ? surface.name == "body" : is_carried()) surface.filter.mask &= ~kDeck;
               return surface;
             }),
      sensors_(config.seed, kTimeStep) {
  if (parts_.on_legs) {
    for (const std::string& name : v60_gait::leg_joint_names()) {
      leg_joints_.push_back(&robot_.joint(name));
      joint_names_.push_back(name);
    }
  }
  for (const std::string& name : parts_.arm_joints) {
    arm_joints_.push_back(&robot_.joint(name));
    joint_names_.push_back(name);
  }
  if (target_.obstructed) {
    obstacle_.emplace(scene_, "obstacle", to_parts({target_.obstacle()}),
                      CollisionFilter{kTarget, ~kSurroundings}, motion_.deck(0.0).pose);
  }
  if (target_.on_cart && !disturbances_.moves_cart()) {
    push_.emplace(CartPush::draw(config.seed));
  }
  if (!parts_.on_legs) require_bolted(config);
  foot_hold_ = 0.25 * config.friction * robot_.mass() * v60_gait::kGravity;
  place_robot(config);
  if (config.arm_mode == ArmMode::kServo && config.driver) {
    arm_ = std::make_unique<DriverArm>(scene_, robot_, parts_.arm_joints, *config.driver);
  } else if (config.arm_mode == ArmMode::kServo) {
    arm_ = std::make_unique<ArmServo>(scene_, robot_, parts_.arm_joints, config.servo_gain,
                                      config.arm_latency);
  } else {
    arm_ = std::make_unique<CompliantArm>(scene_, robot_, parts_.arm_joints, parts_.hand);
  }
  settle();
}

// What a robot without legs cannot do.
void World::Impl::require_bolted(const WorldParams& config) const {
  prf_core::require(config.gait == "stand", "gait", config.gait, "stand: the robot has no legs");
  prf_core::require(config.body_motion.empty(), "body_motion", config.body_motion,
                    "empty: the robot is bolted to the deck");
  for (const Disturbances::Force& force : disturbances_.forces()) {
    prf_core::require(force.unit != Disturbances::Unit::kFootHold, "disturb", config.disturb,
                      "without stumble: the robot has no legs");
  }
}

void World::Impl::place_robot(const WorldParams& config) {
  for (std::size_t i = 0; i < arm_joints_.size(); ++i) {
    const v60_gait::RobotJoint& joint = *arm_joints_[i];
    const double position = config.arm_start[static_cast<Eigen::Index>(i)];
    if (joint.has_position_limits) {
      prf_core::require_between("arm_start of joint " + joint.name, position, joint.lower,
                                joint.upper, "rad");
    }
    robot_.set_position(joint, position);
  }
  std::optional<v60_gait::Stance> stance;
  double height = 0.0;
  if (parts_.on_legs) {
    stance = v60_gait::find_stance(robot_.tree());
    for (std::size_t i = 0; i < leg_joints_.size(); ++i) {
      robot_.set_position(*leg_joints_[i], stance->posture[static_cast<Eigen::Index>(i)]);
    }
    height = robot_.sphere_radius("fl_toe") - stance->toes_in_base[0].z();
  }
  base_start_ = body_motion_
                    ? body_motion_->base_in_platform(0.0)
                    : Eigen::Translation3d(config.base_start_x, config.base_start_y, height) *
                          Eigen::AngleAxisd(config.base_start_yaw, Eigen::Vector3d::UnitZ());
  operator_.emplace(base_start_);
  robot_.set_base_pose(carried_base());
  robot_.update_poses();
  if (is_carried()) {
    base_carrier_ = std::make_unique<BaseCarrier>(scene_, robot_);
    if (stance) {
      legs_ =
          std::make_unique<v60_gait::StiffController>(stance->posture, v60_gait::LegVector::Zero());
    }
  } else {
    v60_gait::BodyModel body;
    body.weight = robot_.mass() * v60_gait::kGravity;
    body.centre_of_mass_in_base =
        robot_.frame(base_link()).pose.inverse() * robot_.centre_of_mass();
    legs_ = v60_gait::make_leg_controller(config.gait, *stance, body, config.friction, config.seed);
  }
}

Eigen::Isometry3d World::Impl::carried_base() const {
  return motion_.deck(time()).pose *
         (body_motion_ ? body_motion_->base_in_platform(time()) : base_start_);
}

// The deck is at rest at times up to 0.
void World::Impl::settle() {
  const auto settling_steps = static_cast<std::int64_t>(std::lround(kSettlingTime / kTimeStep));
  for (steps_ = -settling_steps; steps_ < 0;) step();
  [[maybe_unused]] const auto settling_contacts = contacts.take();
}

FrameState World::Impl::carrier() const {
  if (push_) return push_->cart(time());
  if (target_.on_cart) return disturbances_.cart(time());
  return target_stands_ashore_ ? FrameState() : platform();
}

void World::Impl::disturb() {
  for (const Disturbances::Force& force : disturbances_.forces()) {
    const double share = Disturbances::share(force, time());
    if (share <= 0.0) continue;
    const double unit = force.unit == Disturbances::Unit::kFootHold ? foot_hold_ : 1.0;
    const std::string& link = force.link == "hand"   ? parts_.hand
                              : force.link == "body" ? base_link()
                                                     : force.link;
    push(link, share * unit * force.peak);
  }
}

void World::Impl::step() {
  drive_legs();
  disturb();
  arm_->update(time());
  ++steps_;
  if (base_carrier_) base_carrier_->move_to(carried_base());
  deck_.move_to(platform().pose);
  for (CuboidBody* body : {&box_, &support_}) body->move_to(carrier().pose);
  if (obstacle_) obstacle_->move_to(carrier().pose);
  scene_.step();
  const std::vector<ContactPoint> points = scene_.contact_points();
  contacts.add_step(points);
  judge_fall(points);
}

v60_gait::LegObservation World::Impl::observe_legs() {
  v60_gait::LegObservation observation;
  observation.time = time();
  for (std::size_t i = 0; i < leg_joints_.size(); ++i) {
    observation.positions[static_cast<Eigen::Index>(i)] = robot_.position(*leg_joints_[i]);
    observation.velocities[static_cast<Eigen::Index>(i)] = robot_.velocity(*leg_joints_[i]);
  }
  const FrameState base = robot_.frame(base_link());
  observation.attitude = Eigen::Quaterniond(base.pose.linear());
  observation.angular_velocity = base.pose.linear().transpose() * base.angular;
  if (time() >= 0.0) {
    observation.joystick =
        operator_->joystick(time(), motion_.deck(time()).pose.inverse() * base.pose);
  }
  return sensors_.measure(observation);
}

void World::Impl::drive_legs() {
  if (!legs_) return;
  leg_efforts_ = legs_->torques(observe_legs());
  for (std::size_t i = 0; i < leg_joints_.size(); ++i) {
    const v60_gait::RobotJoint& joint = *leg_joints_[i];
    double& effort = leg_efforts_[static_cast<Eigen::Index>(i)];
    effort = std::clamp(effort, -joint.max_effort, joint.max_effort);
    robot_.apply_torque(joint, effort);
  }
}

void World::Impl::judge_fall(const std::vector<ContactPoint>& points) {
  if (is_carried()) return;
  const Eigen::Isometry3d base_in_deck =
      motion_.deck(time()).pose.inverse() * robot_.frame(base_link()).pose;
  const double tilt = std::acos(std::clamp(base_in_deck.linear()(2, 2), -1.0, 1.0));
  const bool body_on_deck =
      std::any_of(points.begin(), points.end(), [](const ContactPoint& point) {
        return (point.link_a == "body" && point.link_b == "platform") ||
               (point.link_a == "platform" && point.link_b == "body");
      });
  fallen_ = fallen_ || body_on_deck || tilt > prf_msgs::kFallenTilt ||
            base_in_deck.translation().z() < prf_msgs::kFallenHeight;
}

void World::Impl::command_arm(const ArmVector& positions, const ArmVector& velocities) {
  if (!positions.allFinite() || !velocities.allFinite()) {
    throw std::invalid_argument("command_arm: positions and velocities must be finite");
  }
  arm_->command(positions, velocities, time());
}

void World::Impl::command_driver(const DriverPoint& point) {
  if (!point.positions.allFinite() || !point.velocities.allFinite() ||
      !std::isfinite(point.duration)) {
    throw std::invalid_argument("command_driver: all numbers must be finite");
  }
  arm_->send(point, time());
}

void World::Impl::apply_hand_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
  if (!force.allFinite() || !torque.allFinite()) {
    throw std::invalid_argument("apply_hand_wrench: force and torque must be finite");
  }
  arm_->apply_hand_wrench(force, torque);
}

void World::Impl::push(const std::string& link, const Eigen::Vector3d& force) {
  if (!force.allFinite()) throw std::invalid_argument("push: force must be finite");
  robot_.apply_wrench(link, force, Eigen::Vector3d::Zero());
}

JointStates World::Impl::joints() const {
  const auto legs = static_cast<Eigen::Index>(leg_joints_.size());
  const auto arm = static_cast<Eigen::Index>(arm_joints_.size());
  JointStates states;
  states.positions.resize(legs + arm);
  states.velocities.resize(legs + arm);
  for (Eigen::Index i = 0; i < legs + arm; ++i) {
    const v60_gait::RobotJoint& joint = i < legs ? *leg_joints_[static_cast<std::size_t>(i)]
                                                 : *arm_joints_[static_cast<std::size_t>(i - legs)];
    states.positions[i] = robot_.position(joint);
    states.velocities[i] = robot_.velocity(joint);
  }
  states.efforts.resize(legs + arm);
  states.efforts << leg_efforts_.head(legs), arm_->efforts();
  return states;
}

FrameState World::Impl::tag() const {
  const Eigen::Isometry3d tag_in_carrier = target_.tag_in_platform();
  FrameState state = carrier();
  state.linear += state.angular.cross(state.pose.linear() * tag_in_carrier.translation());
  state.pose = state.pose * tag_in_carrier;
  return state;
}

World::World(const std::string& urdf_xml, const WorldParams& config) {
  config.validate();
  impl_ = std::make_unique<Impl>(urdf_xml, config);
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const std::vector<std::string>& World::gait_names() { return v60_gait::gait_names(); }

void World::step() { impl_->step(); }
double World::time() const { return impl_->time(); }
const std::vector<std::string>& World::joint_names() const { return impl_->joint_names(); }
const RobotParts& World::robot() const { return impl_->parts(); }
const std::string& World::base_link() const { return impl_->base_link(); }
JointStates World::joints() const { return impl_->joints(); }
FrameState World::frame(const std::string& link) const { return impl_->robot().frame(link); }
FrameState World::base() const { return impl_->robot().frame(impl_->base_link()); }
FrameState World::platform() const { return impl_->platform(); }
FrameState World::carrier() const { return impl_->carrier(); }
const Disturbances& World::disturbances() const { return impl_->disturbances(); }
FrameState World::tag() const { return impl_->tag(); }
const camera_sim::TargetBox& World::target() const { return impl_->target(); }
std::vector<Contact> World::take_contacts() { return impl_->contacts.take(); }
bool World::fallen() const { return impl_->fallen(); }

void World::command_arm(const ArmVector& positions, const ArmVector& velocities) {
  impl_->command_arm(positions, velocities);
}

void World::command_driver(const DriverPoint& point) { impl_->command_driver(point); }
void World::halt_driver() { impl_->halt_driver(); }

void World::apply_hand_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
  impl_->apply_hand_wrench(force, torque);
}

void World::push(const std::string& link, const Eigen::Vector3d& force) {
  impl_->push(link, force);
}

}  // namespace platform_sim
