// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/scene_renderer.hpp"

#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tag_texture.hpp"
#include "triangle_mesh.hpp"
#include "z_buffer.hpp"

namespace platform_sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

const Vector3d kTowardLight = Vector3d(-0.20, -0.32, 0.93).normalized();
constexpr double kAmbient = 0.55;
constexpr double kShadow = 0.72;  // brightness of the deck in the shadow

const Colour kBackground(0.96, 0.97, 0.98);
const Colour kFloor(0.88, 0.89, 0.90);
const Colour kDeck(0.50, 0.53, 0.57);
const Colour kBox(0.87, 0.72, 0.48);
const Colour kPost(0.62, 0.62, 0.64);
const Colour kDefault(0.6, 0.6, 0.6);

constexpr double kFloorHeight = -0.6;  // m
constexpr double kFloorTile = 0.5;     // m
constexpr int kFloorTiles = 7;         // to each side of the middle
constexpr double kLift = 0.002;        // m, of what lies on a surface

Isometry3d to_eigen(const urdf::Pose& pose) {
  Isometry3d result = Isometry3d::Identity();
  result.linear() =
      Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)
          .toRotationMatrix();
  result.translation() = Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

Mesh to_mesh(const urdf::Geometry& geometry, const std::string& link) {
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = dynamic_cast<const urdf::Box&>(geometry).dim;
      return box_mesh({size.x, size.y, size.z});
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
      return cylinder_mesh(cylinder.radius, cylinder.length);
    }
    case urdf::Geometry::SPHERE:
      return sphere_mesh(dynamic_cast<const urdf::Sphere&>(geometry).radius);
    default:
      throw std::invalid_argument("link " + link +
                                  " has a mesh, must be of boxes, cylinders and spheres");
  }
}

Triangle transformed(const Isometry3d& pose, const Triangle& triangle) {
  return {pose * triangle[0], pose * triangle[1], pose * triangle[2]};
}

Colour shaded(const Colour& colour, const Triangle& triangle) {
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double lit = std::max(0.0, normal.normalized().dot(kTowardLight));
  return colour * (kAmbient + (1.0 - kAmbient) * lit);
}

// A picture in the making; everything is given in world.
class Picture {
 public:
  Picture(const PinholeCamera& camera, const Isometry3d& camera_in_world,
          const Isometry3d& platform)
      : buffer_(camera, kBackground),
        world_to_camera_(camera_in_world.inverse()),
        platform_(platform) {}

  void draw(const Mesh& mesh, const Isometry3d& pose, const Colour& colour) {
    for (const Triangle& triangle : mesh) {
      const Triangle in_world = transformed(pose, triangle);
      buffer_.draw(transformed(world_to_camera_, in_world), shaded(colour, in_world));
    }
  }

  // The same, with its shadow on the deck.
  void draw_solid(const Mesh& mesh, const Isometry3d& pose, const Colour& colour) {
    draw(mesh, pose, colour);
    const Isometry3d in_platform = platform_.inverse() * pose;
    for (const Triangle& triangle : mesh) draw_shadow(transformed(in_platform, triangle));
  }

  [[nodiscard]] cv::Mat finish() const { return buffer_.finish(); }

 private:
  void draw_shadow(const Triangle& in_platform) {
    const Vector3d light = platform_.linear().transpose() * kTowardLight;
    const Vector3d half_deck = 0.5 * deck().size;
    Triangle shadow;
    for (std::size_t i = 0; i < 3; ++i) {
      shadow[i] = in_platform[i] - in_platform[i].z() / light.z() * light;
      if (in_platform[i].z() < 0.0 ||
          (shadow[i].array().abs() > half_deck.array()).head<2>().any()) {
        return;
      }
      shadow[i].z() = kLift;
    }
    const bool faces_down = (shadow[1] - shadow[0]).cross(shadow[2] - shadow[0]).z() < 0.0;
    if (faces_down) std::swap(shadow[1], shadow[2]);
    const Triangle in_world = transformed(platform_, shadow);
    buffer_.draw(transformed(world_to_camera_, in_world), kShadow * shaded(kDeck, in_world));
  }

  ZBuffer buffer_;
  Isometry3d world_to_camera_;
  Isometry3d platform_;
};

void draw_floor(Picture& picture) {
  for (int i = -kFloorTiles; i < kFloorTiles; ++i) {
    for (int j = -kFloorTiles; j < kFloorTiles; ++j) {
      const Eigen::Vector2d low(kFloorTile * i, kFloorTile * j);
      const Mesh tile = rectangle_mesh(low, low + Eigen::Vector2d::Constant(kFloorTile));
      const double tone = (i + j) % 2 == 0 ? 1.0 : 0.97;
      picture.draw(tile, Isometry3d(Eigen::Translation3d(0.0, 0.0, kFloorHeight)), tone * kFloor);
    }
  }
}

void draw_tag(const Isometry3d& tag, double size, Picture& picture) {
  const TagTexture texture;
  const double module = size / texture.black_side();
  const double half = 0.5 * module * texture.side();
  const Isometry3d face = tag * Eigen::Translation3d(0.0, 0.0, kLift);
  for (int v = 0; v < texture.side(); ++v) {
    for (int u = 0; u < texture.side(); ++u) {
      const Eigen::Vector2d low(u * module - half, half - (v + 1) * module);
      const double grey = texture.at(u, v) / 255.0;
      picture.draw(rectangle_mesh(low, low + Eigen::Vector2d::Constant(module)), face,
                   Colour::Constant(grey));
    }
  }
}

}  // namespace

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
  explicit Robot(const std::string& urdf_xml) : model_(urdf::parseURDF(urdf_xml)) {
    if (!model_ || !model_->getRoot()) {
      throw std::invalid_argument("robot description is not a valid URDF");
    }
    add_shapes(*model_->getRoot());
  }

  void draw(const SceneState& state, Picture& picture) const {
    draw_link(*model_->getRoot(), state.base, state, picture);
  }

 private:
  struct Shape {
    Mesh mesh;
    Isometry3d pose;
    Colour colour;
  };

  void add_shapes(const urdf::Link& link) {
    for (const auto& visual : link.visual_array) {
      Shape shape{to_mesh(*visual->geometry, link.name), to_eigen(visual->origin), kDefault};
      if (visual->material) {
        const urdf::Color& colour = visual->material->color;
        shape.colour = Colour(colour.r, colour.g, colour.b);
      }
      shapes_[link.name].push_back(std::move(shape));
    }
    for (const auto& child : link.child_links) add_shapes(*child);
  }

  void draw_link(const urdf::Link& link, const Isometry3d& pose, const SceneState& state,
                 Picture& picture) const {
    const auto shapes = shapes_.find(link.name);
    if (shapes != shapes_.end()) {
      for (const Shape& shape : shapes->second) {
        picture.draw_solid(shape.mesh, pose * shape.pose, shape.colour);
      }
    }
    for (std::size_t i = 0; i < link.child_links.size(); ++i) {
      const urdf::Joint& joint = *link.child_joints[i];
      Isometry3d child = pose * to_eigen(joint.parent_to_joint_origin_transform);
      if (joint.type != urdf::Joint::FIXED) {
        const auto value = state.joints.find(joint.name);
        if (value == state.joints.end()) {
          throw std::invalid_argument("joint " + joint.name + " has no value");
        }
        child.rotate(
            Eigen::AngleAxisd(value->second, Vector3d(joint.axis.x, joint.axis.y, joint.axis.z)));
      }
      draw_link(*link.child_links[i], child, state, picture);
    }
  }

  urdf::ModelInterfaceSharedPtr model_;
  std::map<std::string, std::vector<Shape>> shapes_;
};

SceneRenderer::SceneRenderer(const std::string& urdf_xml, const TargetBox& target)
    : target_(target), robot_(std::make_unique<Robot>(urdf_xml)) {
  target.validate();
}
SceneRenderer::~SceneRenderer() = default;
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;

cv::Mat SceneRenderer::render(const SceneState& state, const PinholeCamera& camera,
                              const Isometry3d& camera_in_world) const {
  Picture picture(camera, camera_in_world, state.platform);
  draw_floor(picture);
  const Cuboid plate = deck();
  picture.draw(box_mesh(plate.size), state.platform * plate.pose_in_platform, kDeck);
  for (const Cuboid& wall : target_.walls()) {
    picture.draw_solid(box_mesh(wall.size), state.platform * wall.pose_in_platform, kBox);
  }
  const Cuboid post = target_.post();
  picture.draw_solid(box_mesh(post.size), state.platform * post.pose_in_platform, kPost);
  draw_tag(state.platform * target_.tag_in_platform(), target_.tag_size, picture);
  robot_->draw(state, picture);
  return picture.finish();
}

}  // namespace platform_sim
