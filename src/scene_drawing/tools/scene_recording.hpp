// SPDX-License-Identifier: BSD-3-Clause
// The true state of a recorded trial and the view that reports show of it.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "scene_drawing/scene_renderer.hpp"

namespace scene_drawing {

struct SceneRecording {
  camera_sim::TargetBox target;
  std::map<std::int64_t, SceneState> states;  // by stamp, ns; never empty

  // State at the last tick not after `time`, s. Throws std::invalid_argument if there is none.
  [[nodiscard]] const SceneState& at(double time) const;
  [[nodiscard]] double end() const { return 1e-9 * static_cast<double>(states.rbegin()->first); }
};

// Reads joint_states and ground_truth/{platform,base,tag}. Throws std::invalid_argument that says
// what a bag lacks.
[[nodiscard]] SceneRecording read_scene(const std::string& bag_path);

// A renderer of the robot in a URDF file.
[[nodiscard]] SceneRenderer make_renderer(const std::string& urdf_path,
                                          const camera_sim::TargetBox& target);

// The whole scene from behind, to the right, `width` pixels wide and 3/4 as high.
[[nodiscard]] cv::Mat draw_overview(const SceneRenderer& renderer, const SceneState& state,
                                    int width);

// A number of the command line, `low` to `high`, else std::invalid_argument with its name.
[[nodiscard]] double to_number(const std::string& name, const std::string& text, double low,
                               double high);

}  // namespace scene_drawing
