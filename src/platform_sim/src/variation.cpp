// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/variation.hpp"

#include <cmath>
#include <cstdio>
#include <prf_core/require.hpp>
#include <random>

namespace platform_sim {
namespace {

constexpr std::uint64_t kStream = 0x7661726965730000;  // apart from the seed's other draws

}  // namespace

Variation Variation::draw(std::uint64_t seed, double scale, const VariationSpread& spread) {
  prf_core::require_between("variation", scale, 0.0, 1.0);
  std::mt19937_64 generator(seed ^ kStream);
  const auto within = [&](double half) {
    const double even = std::ldexp(static_cast<double>(generator() >> 11), -53);
    return scale * half * (2.0 * even - 1.0) + 0.0;  // no negative zero
  };
  Variation drawn;
  for (double& coordinate : drawn.box_position) coordinate = within(spread.box_position);
  drawn.box_yaw = within(spread.box_yaw);
  for (double& coordinate : drawn.robot_position) coordinate = within(spread.robot_position);
  drawn.robot_yaw = within(spread.robot_yaw);
  drawn.friction_factor += within(spread.friction);
  drawn.camera_noise_factor += within(spread.camera_noise);
  return drawn;
}

void Variation::apply_to(WorldParams& config) const {
  config.target.tag_position_in_platform += box_position;
  config.target.yaw += box_yaw;
  config.base_start_x += robot_position.x();
  config.base_start_y += robot_position.y();
  config.base_start_yaw += robot_yaw;
  config.friction *= friction_factor;
}

std::string Variation::text() const {
  char words[200];
  std::snprintf(words, sizeof(words),
                "box by %.0f %.0f %.0f mm and %.1f deg, robot by %.0f %.0f mm and %.1f deg, "
                "friction x %.2f, camera noise x %.2f",
                1e3 * box_position.x(), 1e3 * box_position.y(), 1e3 * box_position.z(),
                box_yaw * 180.0 / M_PI, 1e3 * robot_position.x(), 1e3 * robot_position.y(),
                robot_yaw * 180.0 / M_PI, friction_factor, camera_noise_factor);
  return words;
}

}  // namespace platform_sim
