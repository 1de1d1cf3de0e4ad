// SPDX-License-Identifier: BSD-3-Clause
//
// The inner loop of EndpointSolver, one dimension: whole blocks of nodes from the tables.
#pragma once

#include <Eigen/Core>

namespace elte_planner {

constexpr Eigen::Index kRollOutBlock = 16;

// Pointers to node 0 of the tables, see EndpointSolver::Table.
struct BlockTables {
  const double* error_from_step;
  const double* error_from_error;
  const double* error_offset;
  const double* step_from_step;
  const double* step_from_error;
  const double* step_offset;
};

// Writes plan[first + 1 .. last], where `first` starts a block and the state there is (v, e) to the
// end point `end`. Uses the widest vector instructions that the running processor has.
void roll_out_blocks(const BlockTables& tables, Eigen::Index first, Eigen::Index last, double v,
                     double e, double end, double* plan);

}  // namespace elte_planner
