// SPDX-License-Identifier: BSD-3-Clause
// Everything of a scene but the robot.
#pragma once

#include "scene_canvas.hpp"
#include "scene_drawing/scene_renderer.hpp"

namespace scene_drawing {

// What the robot stands on: the treadmill's deck or, with a cart, the floor.
[[nodiscard]] Ground ground_of(const camera_sim::TargetBox& target);

// Floor, treadmill or cart, post, box and tag.
void draw_scenery(const SceneState& state, const camera_sim::TargetBox& target,
                  SceneCanvas& canvas);

}  // namespace scene_drawing
