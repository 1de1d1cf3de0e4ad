// SPDX-License-Identifier: BSD-3-Clause
#include "block_roll_out.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#define ELTE_PLANNER_HAS_AVX2_PATH 1
#endif

namespace elte_planner {
namespace {

// Plain loops over contiguous memory; the compiler vectorises them for the target of its caller.
__attribute__((always_inline)) inline void roll_out_generic(const BlockTables& tables,
                                                            Eigen::Index first, Eigen::Index last,
                                                            double v, double e, double end,
                                                            double* __restrict plan) {
  const double* __restrict from_step = tables.error_from_step;
  const double* __restrict from_error = tables.error_from_error;
  const double* __restrict offset = tables.error_offset;
  Eigen::Index k = first;
  for (; k + kRollOutBlock <= last; k += kRollOutBlock) {
    for (Eigen::Index i = k + 1; i <= k + kRollOutBlock; ++i) {
      plan[i] = end - (from_step[i] * v + (from_error[i] * e + offset[i]));
    }
    const Eigen::Index b = k + kRollOutBlock;
    const double next_v =
        tables.step_from_step[b] * v + (tables.step_from_error[b] * e + tables.step_offset[b]);
    e = from_error[b] * e + (from_step[b] * v + offset[b]);
    v = next_v;
  }
  for (Eigen::Index i = k + 1; i <= last; ++i) {
    plan[i] = end - (from_step[i] * v + (from_error[i] * e + offset[i]));
  }
}

void roll_out_baseline(const BlockTables& tables, Eigen::Index first, Eigen::Index last, double v,
                       double e, double end, double* plan) {
  roll_out_generic(tables, first, last, v, e, end, plan);
}

#ifdef ELTE_PLANNER_HAS_AVX2_PATH
__attribute__((target("avx2,fma"))) void roll_out_avx2(const BlockTables& tables,
                                                       Eigen::Index first, Eigen::Index last,
                                                       double v, double e, double end,
                                                       double* plan) {
  roll_out_generic(tables, first, last, v, e, end, plan);
}
#endif

using RollOut = void (*)(const BlockTables&, Eigen::Index, Eigen::Index, double, double, double,
                         double*);

RollOut fastest_roll_out() {
#ifdef ELTE_PLANNER_HAS_AVX2_PATH
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return roll_out_avx2;
#endif
  return roll_out_baseline;
}

}  // namespace

void roll_out_blocks(const BlockTables& tables, Eigen::Index first, Eigen::Index last, double v,
                     double e, double end, double* plan) {
  static const RollOut roll_out = fastest_roll_out();
  roll_out(tables, first, last, v, e, end, plan);
}

}  // namespace elte_planner
