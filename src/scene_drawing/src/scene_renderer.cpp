// SPDX-License-Identifier: BSD-3-Clause
#include "scene_drawing/scene_renderer.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "camera_sim/link_shapes.hpp"
#include "scene_canvas.hpp"
#include "scenery.hpp"

namespace scene_drawing {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d look_at(const Vector3d& eye, const Vector3d& target) {
  Isometry3d camera = Isometry3d::Identity();
  camera.translation() = eye;
  camera.linear().col(2) = (target - eye).normalized();
  camera.linear().col(0) = camera.linear().col(2).cross(Vector3d::UnitZ()).normalized();
  camera.linear().col(1) = camera.linear().col(2).cross(camera.linear().col(0));
  return camera;
}

// The robot's visual shapes along its tree of links.
class SceneRenderer::Robot {
 public:
  explicit Robot(const std::string& urdf_xml) : model_(camera_sim::parse_robot(urdf_xml)) {
    add_shapes(*model_->getRoot());
  }

  void draw(const SceneState& state, SceneCanvas& canvas) const {
    draw_link(*model_->getRoot(), state.base, state, canvas);
  }

 private:
  void add_shapes(const urdf::Link& link) {
    shapes_[link.name] = camera_sim::shapes_of(link);
    for (const auto& child : link.child_links) add_shapes(*child);
  }

  void draw_link(const urdf::Link& link, const Isometry3d& pose, const SceneState& state,
                 SceneCanvas& canvas) const {
    for (const camera_sim::LinkShape& shape : shapes_.at(link.name)) {
      canvas.draw_solid(shape.mesh, pose * shape.pose, shape.colour);
    }
    for (std::size_t i = 0; i < link.child_links.size(); ++i) {
      const urdf::Joint& joint = *link.child_joints[i];
      Isometry3d child = pose * camera_sim::to_eigen(joint.parent_to_joint_origin_transform);
      if (joint.type != urdf::Joint::FIXED) {
        const auto value = state.joints.find(joint.name);
        if (value == state.joints.end()) {
          throw std::invalid_argument(
              "joint " + joint.name +
              " has no value, joint_states must name every joint of the robot");
        }
        child.rotate(
            Eigen::AngleAxisd(value->second, Vector3d(joint.axis.x, joint.axis.y, joint.axis.z)));
      }
      draw_link(*link.child_links[i], child, state, canvas);
    }
  }

  urdf::ModelInterfaceSharedPtr model_;
  std::map<std::string, std::vector<camera_sim::LinkShape>> shapes_;
};

SceneRenderer::SceneRenderer(const std::string& urdf_xml, const camera_sim::TargetBox& target)
    : target_(target), robot_(std::make_unique<Robot>(urdf_xml)) {
  target.validate();
}
SceneRenderer::~SceneRenderer() = default;
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;

cv::Mat SceneRenderer::render(const SceneState& state, const camera_sim::PinholeCamera& camera,
                              const Isometry3d& camera_in_world) const {
  SceneCanvas canvas(camera, camera_in_world, state.platform, ground_of(target_));
  draw_scenery(state, target_, canvas);
  robot_->draw(state, canvas);
  return canvas.finish();
}

}  // namespace scene_drawing
