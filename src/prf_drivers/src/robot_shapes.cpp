// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/robot_shapes.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/utility.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <limits>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <utility>

namespace prf_drivers {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d placed(const urdf::Pose& pose) {
  const urdf::Rotation& turn = pose.rotation;
  Isometry3d result = Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).toRotationMatrix();
  result.translation() = Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

urdf::ModelInterfaceSharedPtr parsed(const std::string& text) {
  auto model = urdf::parseURDF(text);
  prf_core::require(model != nullptr, "robot_description", prf_core::quoted(text.substr(0, 40)),
                    "a URDF");
  return model;
}

const urdf::Joint& joint_of(const urdf::ModelInterface& model, const std::string& name) {
  const auto joint = model.getJoint(name);
  prf_core::require(joint != nullptr, "driver/joints", prf_core::quoted(name),
                    "joints of robot_description");
  return *joint;
}

Isometry3d motion(const urdf::Joint& joint, double position) {
  const Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  Isometry3d result = Isometry3d::Identity();
  if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS) {
    result.linear() = Eigen::AngleAxisd(position, axis.normalized()).toRotationMatrix();
  } else if (joint.type == urdf::Joint::PRISMATIC) {
    result.translation() = position * axis.normalized();
  }
  return result;
}

std::shared_ptr<fcl::CollisionGeometryd> geometry(const urdf::Geometry& shape,
                                                  const std::string& link) {
  if (const auto* box = dynamic_cast<const urdf::Box*>(&shape)) {
    return std::make_shared<fcl::Boxd>(box->dim.x, box->dim.y, box->dim.z);
  }
  if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&shape)) {
    return std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
  }
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&shape)) {
    return std::make_shared<fcl::Sphered>(sphere->radius);
  }
  throw std::invalid_argument("collision shape of the link " + prf_core::quoted(link) +
                              " is a mesh, must be box, cylinder or sphere");
}

double distance_between(const fcl::CollisionObjectd& one, const fcl::CollisionObjectd& other) {
  fcl::DistanceRequestd request;
  // The default solver finds boxes with parallel faces too far apart, 0.47 m in place of 0.36.
  request.gjk_solver_type = fcl::GST_INDEP;
  fcl::DistanceResultd result;
  const double distance = fcl::distance(&one, &other, request, result);
  return distance > 0.0 ? distance : 0.0;  // -1 where they overlap
}

// The smallest box around a body, parallel to the axes.
fcl::AABBd box_around(const fcl::CollisionObjectd& object) {
  const fcl::CollisionGeometryd& shape = *object.collisionGeometry();
  const fcl::Transform3d& place = object.getTransform();
  fcl::AABBd box;
  if (const auto* cuboid = dynamic_cast<const fcl::Boxd*>(&shape)) {
    fcl::computeBV(*cuboid, place, box);
  } else if (const auto* cylinder = dynamic_cast<const fcl::Cylinderd*>(&shape)) {
    fcl::computeBV(*cylinder, place, box);
  } else if (const auto* sphere = dynamic_cast<const fcl::Sphered*>(&shape)) {
    fcl::computeBV(*sphere, place, box);
  }
  return box;
}

void keep_nearest(Clearances& found, const std::string& what, double distance) {
  const auto [entry, is_new] = found.emplace(what, distance);
  if (!is_new) entry->second = std::min(entry->second, distance);
}

}  // namespace

JointRange joint_range(const std::string& urdf, const std::vector<std::string>& arm) {
  const auto model = parsed(urdf);
  const double none = std::numeric_limits<double>::infinity();
  const auto count = static_cast<Eigen::Index>(arm.size());
  JointRange range{Eigen::VectorXd::Constant(count, -none), Eigen::VectorXd::Constant(count, none)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const urdf::Joint& joint = joint_of(*model, arm[static_cast<std::size_t>(i)]);
    if (joint.type == urdf::Joint::CONTINUOUS || !joint.limits) continue;
    range.lower[i] = joint.limits->lower;
    range.upper[i] = joint.limits->upper;
  }
  return range;
}

struct RobotShapes::Impl {
  struct Body {
    std::string link;
    std::size_t frame;  // of the link
    int stage;          // joints of the arm between the root and the link
    Isometry3d place;   // in the link
    fcl::CollisionObjectd object;
    fcl::AABBd around;
  };
  // A link; parents come first.
  struct Frame {
    std::size_t parent;
    const urdf::Joint* joint;  // none for the root
    Isometry3d origin;
    int arm;  // index of its joint in the arm, -1: not of the arm
    Isometry3d pose;
  };

  urdf::ModelInterfaceSharedPtr model;
  std::vector<Frame> frames;
  std::vector<Body> bodies;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::size_t base = 0;

  void add(const urdf::LinkConstSharedPtr& link, std::size_t parent, int stage,
           const std::string& base_link, const std::vector<std::string>& arm);
  void pair_up();
};

// NOLINTNEXTLINE(misc-no-recursion): the links of a URDF are a tree.
void RobotShapes::Impl::add(const urdf::LinkConstSharedPtr& link, std::size_t parent, int stage,
                            const std::string& base_link, const std::vector<std::string>& arm) {
  const std::size_t self = frames.size();
  const urdf::Joint* joint = link->parent_joint.get();
  Frame frame{parent, joint, Isometry3d::Identity(), -1, Isometry3d::Identity()};
  if (joint != nullptr) {
    frame.origin = placed(joint->parent_to_joint_origin_transform);
    const auto found = std::find(arm.begin(), arm.end(), joint->name);
    if (found != arm.end()) {
      frame.arm = static_cast<int>(found - arm.begin());
      ++stage;
    }
  }
  frames.push_back(frame);
  if (link->name == base_link) base = self;
  for (const auto& shape : link->collision_array) {
    bodies.push_back({link->name,
                      self,
                      stage,
                      placed(shape->origin),
                      fcl::CollisionObjectd(geometry(*shape->geometry, link->name)),
                      {}});
  }
  for (const auto& child : link->child_links) add(child, self, stage, base_link, arm);
}

void RobotShapes::Impl::pair_up() {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      if (std::abs(bodies[i].stage - bodies[j].stage) > 1) pairs.emplace_back(i, j);
    }
  }
}

RobotShapes::RobotShapes(const std::string& urdf, const std::string& base_link,
                         const std::vector<std::string>& arm)
    : impl_(std::make_unique<Impl>()) {
  impl_->model = parsed(urdf);
  for (const std::string& name : arm) (void)joint_of(*impl_->model, name);
  prf_core::require(impl_->model->getLink(base_link) != nullptr, "base_link",
                    prf_core::quoted(base_link), "a link of robot_description");
  impl_->add(impl_->model->getRoot(), 0, 0, base_link, arm);
  impl_->pair_up();
  const bool carries = std::any_of(impl_->bodies.begin(), impl_->bodies.end(),
                                   [](const Impl::Body& body) { return body.stage > 0; });
  prf_core::require(carries, "robot_description", "an arm without collision shapes",
                    "one with boxes, cylinders or spheres");
  place(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(arm.size())), {});
}

RobotShapes::~RobotShapes() = default;
RobotShapes::RobotShapes(RobotShapes&&) noexcept = default;
RobotShapes& RobotShapes::operator=(RobotShapes&&) noexcept = default;

void RobotShapes::place(const Eigen::VectorXd& arm,
                        const std::map<std::string, double>& elsewhere) {
  for (Impl::Frame& frame : impl_->frames) {
    if (frame.joint == nullptr) continue;
    double position = 0.0;
    if (frame.arm >= 0) {
      prf_core::require(frame.arm < arm.size(), "joints", arm.size(), "one value for each");
      position = arm[frame.arm];
    } else if (const auto found = elsewhere.find(frame.joint->name); found != elsewhere.end()) {
      position = found->second;
    }
    frame.pose = impl_->frames[frame.parent].pose * frame.origin * motion(*frame.joint, position);
  }
  const Isometry3d to_base = impl_->frames[impl_->base].pose.inverse();
  for (Impl::Body& body : impl_->bodies) {
    body.object.setTransform(to_base * impl_->frames[body.frame].pose * body.place);
    body.around = box_around(body.object);
  }
}

Clearances RobotShapes::between_bodies(double within) const {
  Clearances found;
  for (const auto& [i, j] : impl_->pairs) {
    const Impl::Body& one = impl_->bodies[i];
    const Impl::Body& other = impl_->bodies[j];
    if (one.around.distance(other.around) > within) continue;
    const double distance = distance_between(one.object, other.object);
    if (distance < within) keep_nearest(found, one.link + " and " + other.link, distance);
  }
  return found;
}

Clearances RobotShapes::outside(const Box& box, const std::string& name, double within) const {
  const Vector3d size = box.upper - box.lower;
  fcl::CollisionObjectd obstacle(std::make_shared<fcl::Boxd>(size.x(), size.y(), size.z()));
  obstacle.setTranslation(0.5 * (box.lower + box.upper));
  const fcl::AABBd around = box_around(obstacle);
  Clearances found;
  for (const Impl::Body& body : impl_->bodies) {
    if (body.stage == 0 || body.around.distance(around) > within) continue;
    const double distance = distance_between(body.object, obstacle);
    if (distance < within) keep_nearest(found, body.link + " and " + name, distance);
  }
  return found;
}

Clearances RobotShapes::inside(const Box& box, double within) const {
  Clearances found;
  for (const Impl::Body& body : impl_->bodies) {
    if (body.stage == 0) continue;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const std::string wall = body.link + " and the workspace's wall at ";
      const double above = box.upper[axis] - body.around.max_[axis];
      const double below = body.around.min_[axis] - box.lower[axis];
      if (!(above >= within)) keep_nearest(found, wall + "+" + "xyz"[axis], above);
      if (!(below >= within)) keep_nearest(found, wall + "-" + "xyz"[axis], below);
    }
  }
  return found;
}

std::vector<std::string> RobotShapes::ignore_nearer_than(double distance) {
  std::vector<std::string> ignored;
  std::vector<std::pair<std::size_t, std::size_t>> kept;
  for (const auto& [i, j] : impl_->pairs) {
    const Impl::Body& one = impl_->bodies[i];
    const Impl::Body& other = impl_->bodies[j];
    if (distance_between(one.object, other.object) < distance) {
      ignored.push_back(one.link + " and " + other.link);
    } else {
      kept.emplace_back(i, j);
    }
  }
  impl_->pairs = kept;
  std::sort(ignored.begin(), ignored.end());
  ignored.erase(std::unique(ignored.begin(), ignored.end()), ignored.end());
  return ignored;
}

}  // namespace prf_drivers
