// SPDX-License-Identifier: BSD-3-Clause
#include "direction_norms.hpp"

#include <algorithm>
#include <cmath>

#if defined(__x86_64__) && defined(__GNUC__)
#define ELTE_PLANNER_HAS_AVX2_PATH 1
#endif

namespace elte_planner {
namespace {

using Values = std::array<double, kDirections>;
using Nodes = std::array<double, kNormNodes>;

// Partial results side by side, so that the compiler may vectorise sums without reordering them.
constexpr int kLanes = 8;
static_assert(kDirections % kLanes == 0);

struct Extremes {
  double least, greatest;
};

__attribute__((always_inline)) inline Extremes norms_generic(const Directions& directions,
                                                             const std::array<double, 6>& s,
                                                             Values& norms) {
  for (int i = 0; i < kDirections; ++i) {
    const double x = directions.x[i], y = directions.y[i], z = directions.z[i];
    norms[i] = std::abs(s[0] * x) + std::abs(s[1] * x + s[2] * y) +
               std::abs(s[3] * x + s[4] * y + s[5] * z);
  }
  double low[kLanes], high[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) low[lane] = high[lane] = norms[lane];
  for (int i = kLanes; i < kDirections; i += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const double norm = norms[i + lane];
      low[lane] = norm < low[lane] ? norm : low[lane];
      high[lane] = norm > high[lane] ? norm : high[lane];
    }
  }
  return {*std::min_element(low, low + kLanes), *std::max_element(high, high + kLanes)};
}

// Means of the Chebyshev polynomials T_0 .. of the norms, which are scaled to [-1, 1].
__attribute__((always_inline)) inline void moments_generic(const Values& norms, double centre,
                                                           double scale, Nodes& moments) {
  double sums[kNormNodes][kLanes] = {};
  for (int i = 0; i < kDirections; i += kLanes) {
    double t[kLanes], before[kLanes], present[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      t[lane] = present[lane] = (norms[i + lane] - centre) * scale;
      before[lane] = 1.0;
      sums[1][lane] += t[lane];
    }
    for (int k = 2; k < kNormNodes; ++k) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const double next = 2.0 * t[lane] * present[lane] - before[lane];
        before[lane] = present[lane];
        present[lane] = next;
        sums[k][lane] += next;
      }
    }
  }
  moments[0] = 1.0;
  for (int k = 1; k < kNormNodes; ++k) {
    moments[k] = 0.0;
    for (int lane = 0; lane < kLanes; ++lane) moments[k] += sums[k][lane] / kDirections;
  }
}

struct Kernels {
  Extremes (*norms)(const Directions&, const std::array<double, 6>&, Values&);
  void (*moments)(const Values&, double, double, Nodes&);
};

Extremes norms_baseline(const Directions& directions, const std::array<double, 6>& s,
                        Values& norms) {
  return norms_generic(directions, s, norms);
}

void moments_baseline(const Values& norms, double centre, double scale, Nodes& moments) {
  moments_generic(norms, centre, scale, moments);
}

#ifdef ELTE_PLANNER_HAS_AVX2_PATH
__attribute__((target("avx2,fma"))) Extremes norms_avx2(const Directions& directions,
                                                        const std::array<double, 6>& s,
                                                        Values& norms) {
  return norms_generic(directions, s, norms);
}

__attribute__((target("avx2,fma"))) void moments_avx2(const Values& norms, double centre,
                                                      double scale, Nodes& moments) {
  moments_generic(norms, centre, scale, moments);
}
#endif

Kernels fastest_kernels() {
#ifdef ELTE_PLANNER_HAS_AVX2_PATH
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    return {norms_avx2, moments_avx2};
  }
#endif
  return {norms_baseline, moments_baseline};
}

struct Chebyshev {
  Nodes node;  // in [-1, 1]
  // (2 - [k = 0]) / nodes T_k(node j): moments to the weights of the nodes.
  std::array<Nodes, kNormNodes> weight_of_moment;
};

Chebyshev make_chebyshev() {
  Chebyshev result;
  for (int j = 0; j < kNormNodes; ++j) {
    const double angle = M_PI * (j + 0.5) / kNormNodes;
    result.node[j] = std::cos(angle);
    for (int k = 0; k < kNormNodes; ++k) {
      result.weight_of_moment[k][j] = (k == 0 ? 1.0 : 2.0) / kNormNodes * std::cos(k * angle);
    }
  }
  return result;
}

}  // namespace

// The mean of f over the directions is that of its interpolant in the Chebyshev nodes,
//   mean f = sum_k c_k mean T_k,   c_k = (2 - [k = 0]) / n sum_j f(norm_j) T_k(node_j),
// which is a weighted sum of the values in the nodes.
void norm_rule(const Directions& directions, const std::array<double, 6>& s, NormRule& rule) {
  static const Kernels kernels = fastest_kernels();
  static const Chebyshev chebyshev = make_chebyshev();
  Values norms;
  const Extremes extremes = kernels.norms(directions, s, norms);
  rule.least = extremes.least;
  rule.greatest = extremes.greatest;
  if (!(rule.least < rule.greatest)) return;
  const double centre = 0.5 * (rule.least + rule.greatest);
  const double half = 0.5 * (rule.greatest - rule.least);
  Nodes moments;
  kernels.moments(norms, centre, 1.0 / half, moments);
  rule.weight.fill(0.0);
  for (int k = 0; k < kNormNodes; ++k) {
    for (int j = 0; j < kNormNodes; ++j) {
      rule.weight[j] += moments[k] * chebyshev.weight_of_moment[k][j];
    }
  }
  for (int j = 0; j < kNormNodes; ++j) rule.norm[j] = centre + half * chebyshev.node[j];
}

}  // namespace elte_planner
