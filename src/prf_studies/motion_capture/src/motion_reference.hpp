// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot_motion.hpp"

namespace motion_capture {

/// A number that validate_motion compares.
struct FigureKind {
  const char* key;  ///< with its unit
  double slack;     ///< difference that is not worth a word, in that unit
  int digits;       ///< to print
};
constexpr std::size_t kFigureCount = 14;
extern const std::array<FigureKind, kFigureCount> kFigureKinds;

using FigureRow = std::array<double, kFigureCount>;
/// In the order and units of kFigureKinds.
[[nodiscard]] FigureRow figure_row(const MotionFigures& figures);

/// A recording of the real robot: the conditions, and what it showed.
struct MotionCondition {
  std::string name;
  std::string motion;
  std::string gait;
  double window = 0.0;                            ///< s
  std::vector<std::pair<double, double>> pieces;  ///< s, seen parts of the window; none: all of it
  bool without_drift = false;  ///< a straight line is taken off body and tag before measuring
  std::vector<double> rates;   ///< rad/s, of the deck
  std::optional<FigureRow> measured;
};

/// The five conditions under which a Vision 60 with Jaco arm was captured on a treadmill.
[[nodiscard]] const std::vector<MotionCondition>& captured_conditions();

/// The samples of a window from `first` on, cut and straightened as the condition says.
[[nodiscard]] std::vector<MotionPiece> window_of(const MotionCondition& condition,
                                                 const MotionPiece& samples, std::size_t first);
/// Takes a straight line in time off body, rotation and tag.
void remove_drift(std::vector<MotionPiece>& pieces);

/// A capture as CSV at 100 Hz, with the columns that motion_reference.cpp names; a gap in time
/// begins a new piece. Throws std::invalid_argument with file and column.
[[nodiscard]] std::vector<MotionPiece> read_capture(const std::string& path);

}  // namespace motion_capture
