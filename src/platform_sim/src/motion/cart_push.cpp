// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/cart_push.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <random>

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::uint64_t kStream = 0x63617274;  // keeps these draws apart from others of the seed

}  // namespace

CartPush::CartPush(const Params& params) : params_(params) {
  prf_core::require_between("push.start", params.start, 0.0, 3600.0, "s");
  prf_core::require_between("push.duration", params.duration, 0.01, 3600.0, "s");
  prf_core::require_between("push.distance", params.distance, 0.0, 1.0, "m");
  prf_core::require_between("push.heading", params.heading, -2.0 * kPi, 2.0 * kPi, "rad");
}

CartPush::Params CartPush::draw(std::uint64_t seed) {
  std::mt19937_64 generator(seed ^ (kStream << 32));
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(generator() >> 11), -53);
  };
  Params params;
  params.start = uniform(2.0, 5.0);
  params.duration = uniform(2.0, 3.0);
  params.distance = uniform(0.10, 0.15);
  const double side = uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
  params.heading = side * kPi / 2.0 + uniform(-kPi / 9.0, kPi / 9.0);
  return params;
}

FrameState CartPush::cart(double time) const {
  const double u = std::clamp((time - params_.start) / params_.duration, 0.0, 1.0);
  const double path = u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
  const double rate = 30.0 * u * u * (1.0 - u) * (1.0 - u) / params_.duration;
  const Eigen::Vector3d along(std::cos(params_.heading), std::sin(params_.heading), 0.0);
  FrameState cart;
  cart.pose.translation() = params_.distance * path * along;
  cart.linear = params_.distance * rate * along;
  return cart;
}

}  // namespace platform_sim
