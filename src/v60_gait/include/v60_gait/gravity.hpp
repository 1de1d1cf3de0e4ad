// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace v60_gait {

constexpr double kGravity = 9.81;  ///< m/s2, along world -z

}  // namespace v60_gait
