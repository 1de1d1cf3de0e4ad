// SPDX-License-Identifier: BSD-3-Clause
#include "hand_silhouette.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "camera_sim/link_shapes.hpp"
#include "camera_sim/z_buffer.hpp"

namespace camera_sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

const std::string kOpticalFrame = "camera_optical_frame";
const std::string kCameraLink = "camera_link";
constexpr double kLongestEdge = 0.004;  // m, within which the lens bends nothing
constexpr double kFarthest = 1.2;       // of normalised coordinates: beyond is out of every view
constexpr double kNearest = 0.02;       // m before the lens

// Sky above the camera: what shines on the hand turns with it.
const Vector3d kTowardLight = Vector3d(0.2, -0.9, -0.4).normalized();
constexpr double kAmbient = 0.5;

void append_pieces(const Triangle& triangle, Mesh& pieces) {
  std::size_t longest = 0;
  double length = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double edge = (triangle[(i + 1) % 3] - triangle[i]).norm();
    if (edge > length) {
      length = edge;
      longest = i;
    }
  }
  if (length <= kLongestEdge) {
    pieces.push_back(triangle);
    return;
  }
  const Vector3d &a = triangle[longest], &b = triangle[(longest + 1) % 3],
                 &c = triangle[(longest + 2) % 3];
  const Vector3d middle = 0.5 * (a + b);
  append_pieces({a, middle, c}, pieces);
  append_pieces({middle, b, c}, pieces);
}

bool may_be_in_view(const Triangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [](const Vector3d& point) {
    return point.z() >= kNearest && point.head<2>().cwiseAbs().maxCoeff() <= kFarthest * point.z();
  });
}

struct Part {
  Mesh mesh;  // in the optical frame
  Colour colour;
};

// Goes through the links that fixed joints hold together, `pose` in the optical frame.
void collect(const urdf::Link& link, const Isometry3d& pose, const urdf::Link* from,
             std::vector<Part>& parts) {
  if (link.name != kCameraLink) {
    for (const LinkShape& shape : shapes_of(link)) {
      Part part{{}, shape.colour};
      for (const Triangle& triangle : shape.mesh) {
        append_pieces(transformed(pose * shape.pose, triangle), part.mesh);
      }
      parts.push_back(part);
    }
  }
  const auto is_fixed = [](const urdf::Joint& joint) { return joint.type == urdf::Joint::FIXED; };
  const auto parent = link.getParent();
  if (parent && parent.get() != from && is_fixed(*link.parent_joint)) {
    collect(*parent, pose * to_eigen(link.parent_joint->parent_to_joint_origin_transform).inverse(),
            &link, parts);
  }
  for (std::size_t i = 0; i < link.child_links.size(); ++i) {
    const urdf::Link& child = *link.child_links[i];
    const urdf::Joint& joint = *link.child_joints[i];
    if (&child == from || !is_fixed(joint)) continue;
    collect(child, pose * to_eigen(joint.parent_to_joint_origin_transform), &link, parts);
  }
}

cv::Mat grey_levels(const ZBuffer& buffer) {
  cv::Mat grey, result;
  cv::extractChannel(buffer.finish(), grey, 0);
  grey.convertTo(result, CV_32F);
  return result;
}

}  // namespace

Silhouette hand_silhouette(const std::string& urdf_xml, const PinholeCamera& camera) {
  const urdf::ModelInterfaceSharedPtr model = parse_robot(urdf_xml);
  const auto frame = model->getLink(kOpticalFrame);
  if (!frame)
    throw std::invalid_argument("robot description has no link " + kOpticalFrame +
                                ", must have it: the camera looks along its z axis");
  std::vector<Part> parts;
  collect(*frame, Isometry3d::Identity(), nullptr, parts);

  const Colour black = Colour::Zero(), white = Colour::Ones();
  ZBuffer shade(camera, black), mask(camera, black);
  for (const Part& part : parts) {
    const double grey = part.colour.mean();
    for (const Triangle& triangle : part.mesh) {
      if (!may_be_in_view(triangle)) continue;
      const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
      const double lit = std::max(0.0, normal.normalized().dot(kTowardLight));
      shade.draw(triangle, Colour::Constant(grey * (kAmbient + (1.0 - kAmbient) * lit)));
      mask.draw(triangle, white);
    }
  }
  Silhouette result;
  const cv::Mat coverage = grey_levels(mask) / 255.0;
  result.bounds = cv::boundingRect(coverage > 0.0);
  if (result.bounds.empty()) return result;
  result.coverage = coverage(result.bounds).clone();
  result.shade = grey_levels(shade)(result.bounds).clone();
  return result;
}

}  // namespace camera_sim
