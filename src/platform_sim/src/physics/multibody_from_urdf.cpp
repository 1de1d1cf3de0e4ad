// SPDX-License-Identifier: BSD-3-Clause
#include "multibody_from_urdf.hpp"

#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "eigen_bullet.hpp"

namespace platform_sim {
namespace {

// camera_sim::Frame at the centre of mass along the principal axes, in the body's first link, and
// the moments.
std::pair<Eigen::Isometry3d, Eigen::Vector3d> principal_frame(const v60_gait::RigidBody& body) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(body.inertia);
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() = solver.eigenvectors();
  if (frame.linear().determinant() < 0.0) frame.linear().col(0) *= -1.0;
  frame.translation() = body.centre_of_mass;
  return {frame, solver.eigenvalues()};
}

std::unique_ptr<btCollisionShape> make_shape(const v60_gait::CollisionPrimitive& primitive) {
  const Eigen::Vector3d& size = primitive.size;
  switch (primitive.kind) {
    case v60_gait::CollisionPrimitive::Kind::kSphere:
      return std::make_unique<btSphereShape>(size.x());
    case v60_gait::CollisionPrimitive::Kind::kBox:
      return std::make_unique<btBoxShape>(to_bullet(Eigen::Vector3d(0.5 * size)));
    case v60_gait::CollisionPrimitive::Kind::kCylinder:
      break;
  }
  return std::make_unique<btCylinderShapeZ>(btVector3(size.x(), size.x(), 0.5 * size.z()));
}

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

RobotModel::RobotModel(BulletScene& scene, const std::string& urdf_xml, Base base,
                       const SurfaceRule& rule)
    : scene_(scene), tree_(v60_gait::rigid_tree_from_urdf(urdf_xml, base == Base::kFixed)) {
  add_bodies(base);
  colliders_.resize(tree_.bodies.size());
  for (std::size_t i = 0; i < tree_.bodies.size(); ++i) {
    add_collider(static_cast<int>(i), rule(tree_.bodies[i].name));
  }
  scene_.world().addMultiBody(multibody_.get());
  add_position_limits();
  set_base_pose(Eigen::Isometry3d::Identity());
  update_poses();
}

RobotModel::~RobotModel() {
  for (const auto& limit : limits_) scene_.world().removeMultiBodyConstraint(limit.get());
  for (const Collider& collider : colliders_) {
    scene_.world().removeCollisionObject(collider.object.get());
  }
  scene_.world().removeMultiBody(multibody_.get());
}

void RobotModel::add_bodies(Base base) {
  std::vector<Eigen::Vector3d> moments;
  for (const v60_gait::RigidBody& body : tree_.bodies) {
    const auto [frame, body_moments] = principal_frame(body);
    centre_in_link_.push_back(frame);
    moments.push_back(body_moments);
  }
  multibody_ = std::make_unique<btMultiBody>(static_cast<int>(tree_.joints.size()),
                                             tree_.bodies[0].mass, to_bullet(moments[0]),
                                             base == Base::kFixed, /*canSleep=*/false);
  for (std::size_t i = 1; i < tree_.bodies.size(); ++i) {
    const v60_gait::RigidBody& body = tree_.bodies[i];
    const Eigen::Isometry3d joint_in_parent_centre =
        centre_in_link_[at(body.parent)].inverse() * body.joint_in_parent;
    const Eigen::Matrix3d centre_to_link = centre_in_link_[i].linear();
    const Eigen::Matrix3d parent_to_centre =
        (joint_in_parent_centre.linear() * centre_to_link).transpose();
    multibody_->setupRevolute(
        static_cast<int>(i) - 1, body.mass, to_bullet(moments[i]), body.parent - 1,
        to_bullet(Eigen::Quaterniond(parent_to_centre)),
        to_bullet(Eigen::Vector3d(centre_to_link.transpose() * body.axis)),
        to_bullet(Eigen::Vector3d(joint_in_parent_centre.translation())),
        to_bullet(Eigen::Vector3d(centre_to_link.transpose() * body.centre_of_mass)),
        /*disableParentCollision=*/true);
  }
  multibody_->finalizeMultiDof();
  multibody_->setHasSelfCollision(true);
  multibody_->setLinearDamping(0.0);
  multibody_->setAngularDamping(0.0);
}

// Every body gets a collider, an empty one if it has no shape: Bullet silently ignores motors and
// limits of links without.
void RobotModel::add_collider(int body, const RobotSurface& surface) {
  Collider& collider = colliders_[at(body)];
  auto compound = std::make_unique<btCompoundShape>();
  for (const v60_gait::CollisionPrimitive& primitive : tree_.bodies[at(body)].primitives) {
    primitives_.push_back(make_shape(primitive));
    compound->addChildShape(to_bullet(centre_in_link_[at(body)].inverse() * primitive.pose),
                            primitives_.back().get());
    collider.label.shape_names.push_back(surface.name.empty() ? primitive.link : surface.name);
  }
  const bool is_empty = compound->getNumChildShapes() == 0;
  collider.shape = std::move(compound);
  if (is_empty) collider.shape = std::make_unique<btEmptyShape>();

  collider.object = std::make_unique<btMultiBodyLinkCollider>(multibody_.get(), body - 1);
  collider.object->setCollisionShape(collider.shape.get());
  collider.object->setUserPointer(&collider.label);
  collider.object->setFriction(surface.friction);
  collider.object->setContactStiffnessAndDamping(surface.stiffness, surface.damping);
  scene_.world().addCollisionObject(collider.object.get(), surface.filter.group,
                                    is_empty ? 0 : surface.filter.mask);
  if (body == 0) {
    multibody_->setBaseCollider(collider.object.get());
  } else {
    multibody_->getLink(body - 1).m_collider = collider.object.get();
  }
}

void RobotModel::add_position_limits() {
  for (const v60_gait::RobotJoint& joint : tree_.joints) {
    if (!joint.has_position_limits) continue;
    limits_.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(
        multibody_.get(), joint.body - 1, joint.lower, joint.upper));
    scene_.world().addMultiBodyConstraint(limits_.back().get());
  }
}

const v60_gait::RobotJoint& RobotModel::joint(const std::string& name) const {
  for (const v60_gait::RobotJoint& joint : tree_.joints) {
    if (joint.name == name) return joint;
  }
  throw std::invalid_argument("robot description has no movable joint '" + name +
                              "', must have it");
}

double RobotModel::mass() const {
  double mass = 0.0;
  for (const v60_gait::RigidBody& body : tree_.bodies) mass += body.mass;
  return mass;
}

double RobotModel::sphere_radius(const std::string& link) const {
  const v60_gait::RigidBody& body = tree_.bodies[at(find_link(link).body)];
  for (const v60_gait::CollisionPrimitive& primitive : body.primitives) {
    const bool is_sphere = primitive.kind == v60_gait::CollisionPrimitive::Kind::kSphere;
    if (is_sphere && primitive.link == link) return primitive.size.x();
  }
  throw std::invalid_argument("link '" + link +
                              "' has no sphere as collision shape, must have one");
}

double RobotModel::position(const v60_gait::RobotJoint& joint) const {
  return multibody_->getJointPos(joint.body - 1);
}

double RobotModel::velocity(const v60_gait::RobotJoint& joint) const {
  return multibody_->getJointVel(joint.body - 1);
}

void RobotModel::set_position(const v60_gait::RobotJoint& joint, double position) {
  multibody_->setJointPos(joint.body - 1, position);
}

void RobotModel::set_base_pose(const Eigen::Isometry3d& pose) {
  multibody_->setBaseWorldTransform(to_bullet(pose * centre_in_link_[0]));
}

void RobotModel::set_at_rest() {
  multibody_->setBaseVel(btVector3(0.0, 0.0, 0.0));
  multibody_->setBaseOmega(btVector3(0.0, 0.0, 0.0));
  for (int link = 0; link < multibody_->getNumLinks(); ++link) multibody_->setJointVel(link, 0.0);
}

void RobotModel::update_poses() {
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> origins;
  multibody_->forwardKinematics(rotations, origins);
  multibody_->updateCollisionObjectWorldTransforms(rotations, origins);
}

Eigen::Isometry3d RobotModel::centre_pose(int body) const {
  return to_eigen(body == 0 ? multibody_->getBaseWorldTransform()
                            : multibody_->getLink(body - 1).m_cachedWorldTransform);
}

// From the base outward: w = w_parent + a dq, v = v_parent + w_parent x (p - c_parent)
// + w x (c - p), with p a point of the joint's axis a and c the centres of mass.
FrameState RobotModel::centre_state(int body) const {
  FrameState state;
  state.pose = centre_pose(body);
  if (body == 0) {
    state.linear = to_eigen(multibody_->getBaseVel());
    state.angular = to_eigen(multibody_->getBaseOmega());
    return state;
  }
  const v60_gait::RigidBody& moved = tree_.bodies[at(body)];
  const FrameState parent = centre_state(moved.parent);
  const Eigen::Isometry3d link = state.pose * centre_in_link_[at(body)].inverse();
  const Eigen::Vector3d& pivot = link.translation();
  state.angular = parent.angular + multibody_->getJointVel(body - 1) * (link.linear() * moved.axis);
  state.linear = parent.linear + parent.angular.cross(pivot - parent.pose.translation()) +
                 state.angular.cross(state.pose.translation() - pivot);
  return state;
}

const v60_gait::LinkFrame& RobotModel::find_link(const std::string& name) const {
  const auto found = tree_.links.find(name);
  if (found != tree_.links.end()) return found->second;
  throw std::invalid_argument("robot description has no link '" + name + "', must have it");
}

FrameState RobotModel::frame(const std::string& link) const {
  const v60_gait::LinkFrame& frame = find_link(link);
  const FrameState centre = centre_state(frame.body);
  FrameState state = centre;
  state.pose = centre.pose * centre_in_link_[at(frame.body)].inverse() * frame.pose;
  state.linear += centre.angular.cross(state.pose.translation() - centre.pose.translation());
  return state;
}

Eigen::Vector3d RobotModel::gravity() const { return to_eigen(scene_.world().getGravity()); }

Eigen::Vector3d RobotModel::centre_of_mass() const {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < tree_.bodies.size(); ++i) {
    moment += tree_.bodies[i].mass * centre_pose(static_cast<int>(i)).translation();
  }
  return moment / mass();
}

// Outer bodies first: each adds its weight and first moment to its parent.
Eigen::VectorXd RobotModel::gravity_torques() const {
  Eigen::VectorXd torques(tree_.joints.size());
  std::vector<double> mass(tree_.bodies.size(), 0.0);
  std::vector<Eigen::Vector3d> moment(tree_.bodies.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = tree_.bodies.size() - 1; i > 0; --i) {
    const v60_gait::RigidBody& body = tree_.bodies[i];
    const Eigen::Isometry3d centre = centre_pose(static_cast<int>(i));
    const Eigen::Isometry3d link = centre * centre_in_link_[i].inverse();
    mass[i] += body.mass;
    moment[i] += body.mass * centre.translation();
    const Eigen::Vector3d lever = moment[i] - mass[i] * link.translation();
    torques[static_cast<Eigen::Index>(i) - 1] =
        (link.linear() * body.axis).dot(lever.cross(gravity()));
    mass[at(body.parent)] += mass[i];
    moment[at(body.parent)] += moment[i];
  }
  return torques;
}

void RobotModel::apply_torque(const v60_gait::RobotJoint& joint, double torque) {
  multibody_->addJointTorque(joint.body - 1, torque);
}

void RobotModel::apply_wrench(const std::string& link, const Eigen::Vector3d& force,
                              const Eigen::Vector3d& torque) {
  const v60_gait::LinkFrame& frame = find_link(link);
  const Eigen::Isometry3d centre = centre_pose(frame.body);
  const Eigen::Isometry3d pose = centre * centre_in_link_[at(frame.body)].inverse() * frame.pose;
  const Eigen::Vector3d lever = pose.translation() - centre.translation();
  const btVector3 total = to_bullet(Eigen::Vector3d(torque + lever.cross(force)));
  if (frame.body == 0) {
    multibody_->addBaseForce(to_bullet(force));
    multibody_->addBaseTorque(total);
  } else {
    multibody_->addLinkForce(frame.body - 1, to_bullet(force));
    multibody_->addLinkTorque(frame.body - 1, total);
  }
}

}  // namespace platform_sim
