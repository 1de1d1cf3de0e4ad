// SPDX-License-Identifier: BSD-3-Clause
#include "motion_reference.hpp"

#include <Eigen/QR>
#include <cmath>
#include <prf_core/table.hpp>
#include <stdexcept>

namespace motion_capture {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr double kSampleRate = 100.0;  // Hz
constexpr double kGap = 0.02;          // s

}  // namespace

const std::array<FigureKind, kFigureCount> kFigureKinds{{{"body_x_mm", 3.0, 0},
                                                         {"body_y_mm", 3.0, 0},
                                                         {"body_z_mm", 3.0, 0},
                                                         {"body_roll_deg", 0.5, 1},
                                                         {"body_pitch_deg", 0.5, 1},
                                                         {"body_yaw_deg", 0.5, 1},
                                                         {"tag_x_mm", 3.0, 0},
                                                         {"tag_y_mm", 3.0, 0},
                                                         {"tag_z_mm", 3.0, 0},
                                                         {"tag_speed_rms_mm_s", 0.0, 0},
                                                         {"tag_speed_p95_mm_s", 0.0, 0},
                                                         {"cadence_hz", 0.0, 2},
                                                         {"duty", 0.0, 2},
                                                         {"lift_mm", 0.0, 0}}};

FigureRow figure_row(const MotionFigures& figures) {
  const Eigen::Vector3d body = 1000.0 * figures.body_range;
  const Eigen::Vector3d turn = figures.rotation_range / kDegree;
  const Eigen::Vector3d tag = 1000.0 * figures.tag_range;
  return {body.x(),
          body.y(),
          body.z(),
          turn.x(),
          turn.y(),
          turn.z(),
          tag.x(),
          tag.y(),
          tag.z(),
          1000.0 * figures.tag_speed_rms,
          1000.0 * figures.tag_speed_p95,
          figures.cadence,
          figures.duty,
          1000.0 * figures.lift};
}

// Own evaluation, with the code of robot_motion.cpp, of the optical motion capture in the public
// repository purdue-tracelab/quadruped_assessment, V60/run_Data/v60_data/Jun12-2023/trc_files
// (12 June 2023), at 25 Hz: BothDRS_Motion2_1, BothDRS_Motion1_1, ArmBodyNoDRS1,
// JustArmDRS_Motion2_1, JustArmDRS_Motion1_1. One trial and one window each.
const std::vector<MotionCondition>& captured_conditions() {
  static const std::vector<MotionCondition> conditions{
      {"none_step",
       "none",
       "step",
       2.2,
       {},
       true,
       {},
       FigureRow{6, 12, 5, 0.9, 0.7, 1.5, 10, 14, 11, 48, 78, 1.25, 0.59, 131}},
      {"light_step",
       "light",
       "step",
       8.36,
       {},
       false,
       {2.001, 1.5},
       FigureRow{69, 117, 12, 2.9, 2.5, 3.9, 88, 120, 47, 105, 177, 1.34, 0.60, 131}},
      {"heavy_step",
       "heavy",
       "step",
       9.44,
       {},
       false,
       {2.4, 4.8, 7.2},
       FigureRow{131, 167, 20, 6.0, 6.4, 8.7, 187, 156, 111, 216, 326, 1.37, 0.60, 131}},
      {"light_stand",
       "light",
       "stand",
       5.72,
       {{0.0, 0.48}, {1.32, 1.80}, {2.68, 3.16}, {3.96, 4.44}, {5.24, 5.72}},
       false,
       {2.001, 1.5},
       FigureRow{36, 33, 4, 3.2, 1.8, 0.7, 57, 74, 34, 69, 109, 0, 1, 0}},
      {"heavy_stand",
       "heavy",
       "stand",
       2.72,
       {},
       false,
       {2.4},
       FigureRow{87, 50, 3, 5.3, 5.2, 0.9, 144, 111, 101, 184, 275, 0, 1, 0}}};
  return conditions;
}

std::vector<MotionPiece> window_of(const MotionCondition& condition, const MotionPiece& samples,
                                   std::size_t first) {
  auto spans = condition.pieces;
  if (spans.empty()) spans.emplace_back(0.0, condition.window);
  std::vector<MotionPiece> pieces;
  for (const auto& [begin, end] : spans) {
    const auto from = samples.begin() + static_cast<std::ptrdiff_t>(first);
    pieces.emplace_back(from + std::lround(begin * kSampleRate),
                        from + std::lround(end * kSampleRate) + 1);
  }
  if (condition.without_drift) remove_drift(pieces);
  return pieces;
}

void remove_drift(std::vector<MotionPiece>& pieces) {
  std::vector<MotionSample*> samples;
  for (MotionPiece& piece : pieces) {
    for (MotionSample& sample : piece) samples.push_back(&sample);
  }
  const auto count = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixX2d line(count, 2);
  Eigen::Matrix<double, Eigen::Dynamic, 9> values(count, 9);
  for (Eigen::Index i = 0; i < count; ++i) {
    const MotionSample& sample = *samples[static_cast<std::size_t>(i)];
    line.row(i) << 1.0, sample.time;
    values.row(i) << sample.body.transpose(), sample.roll_pitch_yaw.transpose(),
        sample.tag.transpose();
  }
  values -= line * line.colPivHouseholderQr().solve(values).eval();
  for (Eigen::Index i = 0; i < count; ++i) {
    MotionSample& sample = *samples[static_cast<std::size_t>(i)];
    sample.body = values.row(i).segment<3>(0);
    sample.roll_pitch_yaw = values.row(i).segment<3>(3);
    sample.tag = values.row(i).segment<3>(6);
  }
}

std::vector<MotionPiece> read_capture(const std::string& path) {
  std::ifstream file = prf_core::open_table(path);
  prf_core::TableReader reader(file, path);
  reader.read_header("t_s,deck_sway_left_m,...");
  const auto value = [&](const char* column) { return reader.number(reader.column(column)); };
  std::vector<MotionPiece> pieces;
  while (reader.next()) {
    MotionSample sample;
    sample.time = value("t_s");
    sample.deck_sway = value("deck_sway_left_m");
    sample.deck_pitch = value("deck_pitch_nosedown_rad");
    sample.body = {value("body_x_m"), value("body_y_m"), value("body_z_m")};
    sample.roll_pitch_yaw = {value("body_roll_rad"), value("body_pitch_rad"),
                             value("body_yaw_rad")};
    sample.tag = {value("tag_in_body_x_m"), value("tag_in_body_y_m"), value("tag_in_body_z_m")};
    sample.toe_heights = {value("toe_fl_h_m"), value("toe_fr_h_m"), value("toe_al_h_m"),
                          value("toe_ar_h_m")};
    if (pieces.empty() || sample.time > pieces.back().back().time + kGap) pieces.emplace_back();
    pieces.back().push_back(sample);
  }
  return pieces;
}

}  // namespace motion_capture
