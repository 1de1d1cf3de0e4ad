// SPDX-License-Identifier: BSD-3-Clause
//
// |S u|_1 over the directions u of confidence_radius.cpp.
#pragma once

#include <array>

namespace elte_planner {

constexpr int kDirections = 512;
constexpr int kNormNodes = 12;

// Coordinates of the directions, those beyond the number of dimensions are 0.
struct Directions {
  std::array<double, kDirections> x, y, z;
};

// A rule of Gauss's kind for means over the directions of a smooth function of |S u|_1.
struct NormRule {
  double least = 0.0;  // of the norms
  double greatest = 0.0;
  std::array<double, kNormNodes> norm, weight;  // only set when least < greatest
};

// S: lower triangle by rows, s00 s10 s11 s20 s21 s22.
void norm_rule(const Directions& directions, const std::array<double, 6>& s, NormRule& rule);

}  // namespace elte_planner
