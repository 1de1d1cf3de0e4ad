// SPDX-License-Identifier: BSD-3-Clause
#include "robot_motion.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace motion_capture {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSamplePeriod = 0.01;           // s
constexpr double kCutOff = 8.0;                  // Hz
constexpr double kLifted = 0.012;                // m
constexpr std::size_t kShortestPiece = 10;       // samples
constexpr double kCarries = 20.0;                // N, a foot with less is not counted as standing
const Eigen::Vector3d kMarkers(0.0, 0.0, 0.03);  // m, in base_link
const std::array<std::string, 4> kToes{"fl_toe", "fr_toe", "rl_toe", "rr_toe"};

double quantile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  const double place = part * static_cast<double>(values.size() - 1);
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, values.size() - 1);
  return values[before] + (place - static_cast<double>(before)) * (values[after] - values[before]);
}

template <class Select>
Eigen::Vector3d range(const std::vector<MotionPiece>& pieces, const Select& select) {
  Eigen::Vector3d low = select(pieces.front().front());
  Eigen::Vector3d high = low;
  for (const MotionPiece& piece : pieces) {
    for (const MotionSample& sample : piece) {
      low = low.cwiseMin(select(sample));
      high = high.cwiseMax(select(sample));
    }
  }
  return high - low;
}

// Butterworth low-pass of second order, bilinear transform, from rest at the first value.
void low_pass(std::vector<Eigen::Vector3d>& values) {
  const double k = std::tan(kPi * kCutOff * kSamplePeriod);
  const double scale = 1.0 / (1.0 + std::sqrt(2.0) * k + k * k);
  const double b = k * k * scale;
  const double a1 = 2.0 * (k * k - 1.0) * scale;
  const double a2 = (1.0 - std::sqrt(2.0) * k + k * k) * scale;
  Eigen::Vector3d x1 = values.front(), x2 = x1, y1 = x1, y2 = x1;
  for (Eigen::Vector3d& value : values) {
    const Eigen::Vector3d y = b * (value + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
    x2 = x1;
    x1 = value;
    y2 = y1;
    y1 = value = y;
  }
}

// Forth and back, so without lag.
std::vector<double> tag_speeds(const MotionPiece& piece) {
  std::vector<Eigen::Vector3d> tag;
  for (const MotionSample& sample : piece) tag.push_back(sample.tag);
  for (int pass = 0; pass < 2; ++pass) {
    low_pass(tag);
    std::reverse(tag.begin(), tag.end());
  }
  std::vector<double> speeds;
  for (std::size_t i = 1; i + 1 < tag.size(); ++i) {
    speeds.push_back((tag[i + 1] - tag[i - 1]).norm() / (2.0 * kSamplePeriod));
  }
  return speeds;
}

struct Steps {
  std::vector<double> strides;  // s, from lift-off to lift-off
  std::vector<double> stances;  // s, the part of it on the ground
  std::vector<double> lifts;    // m
};

void add_steps(const MotionPiece& piece, Eigen::Index toe, Steps& steps) {
  std::vector<double> heights;
  for (const MotionSample& sample : piece) heights.push_back(sample.toe_heights[toe]);
  const double ground = quantile(heights, 0.25);
  double lifted = -1.0, landed = -1.0, highest = 0.0;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    const double before = heights[i - 1] - ground - kLifted;
    const double now = heights[i] - ground - kLifted;
    const double crossing = (static_cast<double>(i - 1) + before / (before - now)) * kSamplePeriod;
    highest = std::max(highest, heights[i] - ground);
    if (before < 0.0 && now >= 0.0) {
      if (lifted >= 0.0 && landed > lifted) {
        steps.strides.push_back(crossing - lifted);
        steps.stances.push_back(crossing - landed);
      }
      lifted = crossing;
      highest = 0.0;
    } else if (before >= 0.0 && now < 0.0 && lifted >= 0.0) {
      landed = crossing;
      steps.lifts.push_back(highest);
    }
  }
}

}  // namespace

MotionFigures measure_motion(const std::vector<MotionPiece>& pieces) {
  if (pieces.empty()) throw std::invalid_argument("measure_motion: no piece of motion");
  MotionFigures figures;
  std::vector<double> speeds;
  Steps steps;
  for (const MotionPiece& piece : pieces) {
    if (piece.size() < kShortestPiece) {
      throw std::invalid_argument("measure_motion: a piece has " + std::to_string(piece.size()) +
                                  " samples, must be at least " + std::to_string(kShortestPiece));
    }
    const std::vector<double> of_piece = tag_speeds(piece);
    speeds.insert(speeds.end(), of_piece.begin(), of_piece.end());
    for (Eigen::Index toe = 0; toe < 4; ++toe) add_steps(piece, toe, steps);
  }
  figures.body_range = range(pieces, [](const MotionSample& s) { return s.body; });
  figures.rotation_range = range(pieces, [](const MotionSample& s) { return s.roll_pitch_yaw; });
  figures.tag_range = range(pieces, [](const MotionSample& s) { return s.tag; });
  double squares = 0.0;
  for (double speed : speeds) squares += speed * speed;
  figures.tag_speed_rms = std::sqrt(squares / static_cast<double>(speeds.size()));
  figures.tag_speed_p95 = quantile(speeds, 0.95);
  if (!steps.strides.empty()) {
    const double stride = quantile(steps.strides, 0.5);
    figures.cadence = 1.0 / stride;
    figures.duty = quantile(steps.stances, 0.5) / stride;
    figures.lift = quantile(steps.lifts, 0.5);
  }
  return figures;
}

Eigen::Matrix3Xd tag_lines(const std::vector<MotionPiece>& pieces,
                           const std::vector<double>& rates) {
  Eigen::Index count = 0;
  for (const MotionPiece& piece : pieces) count += static_cast<Eigen::Index>(piece.size());
  const auto lines = static_cast<Eigen::Index>(rates.size());
  Eigen::MatrixXd basis(count, 1 + 2 * lines);
  Eigen::MatrixX3d values(count, 3);
  Eigen::Index row = 0;
  for (const MotionPiece& piece : pieces) {
    for (const MotionSample& sample : piece) {
      basis(row, 0) = 1.0;
      for (Eigen::Index line = 0; line < lines; ++line) {
        const double angle = rates[static_cast<std::size_t>(line)] * sample.time;
        basis(row, 1 + 2 * line) = std::cos(angle);
        basis(row, 2 + 2 * line) = std::sin(angle);
      }
      values.row(row++) = sample.tag;
    }
  }
  const Eigen::MatrixX3d fit = basis.colPivHouseholderQr().solve(values);
  Eigen::Matrix3Xd result(3, lines + 1);
  for (Eigen::Index line = 0; line < lines; ++line) {
    result.col(line) = fit.middleRows(1 + 2 * line, 2).colwise().norm();
  }
  result.col(lines) =
      (values - basis * fit).colwise().norm() / std::sqrt(static_cast<double>(count));
  return result;
}

void MotionObserver::step(platform_sim::World& world,
                          const std::function<void(platform_sim::World&)>& before) {
  const auto steps = std::lround(kSamplePeriod / platform_sim::World::kTimeStep);
  for (long i = 0; i < steps; ++i) {
    if (before) before(world);
    world.step();
    const platform_sim::FrameState platform = world.platform();
    for (const platform_sim::Contact& contact : world.take_contacts()) {
      const auto toe = std::find(kToes.begin(), kToes.end(), contact.link_a);
      if (toe == kToes.end() || contact.link_b != "platform" || contact.force < kCarries) continue;
      const platform_sim::FrameState state = world.frame(*toe);
      const auto velocity_at = [&](const platform_sim::FrameState& frame) -> Eigen::Vector3d {
        return frame.linear + frame.angular.cross(contact.position - frame.pose.translation());
      };
      const Eigen::Vector3d sliding =
          platform.pose.linear().transpose() * (velocity_at(state) - velocity_at(platform));
      slip_ += 0.25 * platform_sim::World::kTimeStep * sliding.head<2>().norm();
    }
  }
  const Eigen::Isometry3d platform = world.platform().pose;
  const Eigen::Isometry3d body =
      platform.inverse() * world.base().pose * Eigen::Translation3d(kMarkers);
  const Eigen::Matrix3d& r = body.linear();
  MotionSample sample;
  sample.time = world.time();
  sample.deck_sway = platform.translation().y();
  sample.deck_pitch = -std::asin(platform.linear()(2, 0));
  sample.body = body.translation();
  sample.roll_pitch_yaw = {std::atan2(r(2, 1), r(2, 2)), -std::asin(r(2, 0)),
                           std::atan2(r(1, 0), r(0, 0))};
  sample.tag = body.inverse() * (platform.inverse() * world.tag().pose.translation());
  for (std::size_t i = 0; i < kToes.size(); ++i) {
    const Eigen::Vector3d toe = platform.inverse() * world.frame(kToes[i]).pose.translation();
    sample.toe_heights[static_cast<Eigen::Index>(i)] = toe.z();
  }
  samples_.push_back(sample);
}

}  // namespace motion_capture
