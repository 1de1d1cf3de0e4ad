// SPDX-License-Identifier: BSD-3-Clause
// Everything of a scene but the robot.
#pragma once

#include "platform_sim/scene_renderer.hpp"
#include "scene_canvas.hpp"

namespace platform_sim {

// What the robot stands on: the treadmill's deck or, with a cart, the floor.
[[nodiscard]] Ground ground_of(const TargetBox& target);

// Floor, treadmill or cart, post, box and tag.
void draw_scenery(const SceneState& state, const TargetBox& target, SceneCanvas& canvas);

}  // namespace platform_sim
