// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace platform_sim {

constexpr double kGravity = 9.81;  ///< m/s2, along world -z

}  // namespace platform_sim
