// SPDX-License-Identifier: BSD-3-Clause
#include "feet.hpp"

#include <cmath>
#include <utility>

namespace v60_gait {
namespace {

constexpr double kSlopeLearning = 12.0;  // 1/s, well above the deck's 2.4 rad/s

Eigen::Vector3d mean_on_ground(const Feet& feet, const std::array<Eigen::Vector3d, 4>& values) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (std::size_t leg = 0; leg < 4; ++leg) {
    if (!feet.on_ground[leg]) continue;
    sum += values[leg];
    count += 1.0;
  }
  return sum / count;
}

}  // namespace

LegObservation StartHeading::relative(LegObservation observation) {
  if (!heading_) {
    const Eigen::Vector3d ahead = observation.attitude * Eigen::Vector3d::UnitX();
    heading_ = Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ());
  }
  observation.attitude = heading_->inverse() * observation.attitude;
  return observation;
}

Feet observe_feet(const Stance& stance, const LegObservation& observation,
                  const std::array<bool, 4>& on_ground) {
  Feet feet;
  feet.on_ground = on_ground;
  const Eigen::Matrix3d rotation = observation.attitude.toRotationMatrix();
  for (std::size_t leg = 0; leg < 4; ++leg) {
    const auto joint = static_cast<Eigen::Index>(3 * leg);
    const Eigen::Vector3d angles = observation.positions.segment<3>(joint);
    const Eigen::Vector3d toe = stance.legs[leg].toe(angles);
    feet.jacobians[leg] = rotation * stance.legs[leg].jacobian(angles);
    feet.positions[leg] = rotation * toe;
    feet.velocities[leg] = feet.jacobians[leg] * observation.velocities.segment<3>(joint) +
                           rotation * observation.angular_velocity.cross(toe);
  }
  return feet;
}

Eigen::Vector3d body_over_feet(const Feet& feet) { return -mean_on_ground(feet, feet.positions); }

Eigen::Vector3d body_velocity_over_feet(const Feet& feet) {
  return -mean_on_ground(feet, feet.velocities);
}

void SlopeEstimate::update(const Feet& feet, double duration) {
  for (const auto& [front, rear] : {std::pair<std::size_t, std::size_t>{0, 3}, {1, 2}}) {
    if (!feet.on_ground[front] || !feet.on_ground[rear]) continue;
    const Eigen::Vector3d way = feet.positions[front] - feet.positions[rear];
    const Eigen::Vector2d direction(-way.x(), way.y());
    const double error = way.z() - direction.dot(slope_);
    slope_ += kSlopeLearning * duration * error / direction.squaredNorm() * direction;
  }
}

}  // namespace v60_gait
