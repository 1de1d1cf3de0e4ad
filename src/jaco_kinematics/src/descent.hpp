// SPDX-License-Identifier: BSD-3-Clause
// The nearest solution of a pose, found from joints close by. Private to the library.
#pragma once

#include "geometry.hpp"
#include "ik_cost.hpp"

namespace jaco_kinematics {

// Sequential quadratic steps from q on
//
//   minimise cost(q)   subject to   forward(q) = pose,   limits of joints 2, 4 and 6
//
// Each is Newton's step to the pose and the step along the self-motion that lowers the cost; once
// the latter has become small, Newton's step alone. True if it ends at the pose within limits;
// `frames` are those of q in the end. It passes the shoulder's singularity (q2 = pi), where the
// branches of the closed form change places.
bool descend(const Eigen::Isometry3d& pose, const IkCost& cost, JointVector* q, Frames* frames);

}  // namespace jaco_kinematics
