// SPDX-License-Identifier: BSD-3-Clause
// The loaders of files and of the robot's description.
#include <cmath>
#include <prf_ros/frame_tree.hpp>
#include <sstream>

#include "elte_planner/demonstration.hpp"
#include "elte_planner/demonstration_limits.hpp"
#include "fuzz_target.hpp"
#include "platform_sim/platform_profile.hpp"
#include "prf_decision/hmm/hmm_file.hpp"

FUZZ_TARGET(demonstration_csv) {
  fuzz::accepts([&] {
    std::istringstream in(bytes.text());
    const auto read = elte_planner::read_demonstration(in, "demo.csv");
    const auto nodes = read.resampled_by_arc_length(20);
    fuzz::expect(nodes.positions().allFinite(), "positions are finite");
    fuzz::expect(nodes.goal_in_target().is_finite(), "the goal is finite");
    elte_planner::DemonstrationLimits limits;
    limits.reach = 1.3;
    elte_planner::require_executable(read, limits);
    fuzz::expect(read.samples().back().time <= 600.0, "an executable one ends in time");
  });
}

FUZZ_TARGET(hmm_file) {
  const std::string path = fuzz::file_with(bytes, ".yaml");
  fuzz::accepts([&] {
    const auto hmm = prf_decision::load_hmm(path);
    fuzz::expect(!prf_decision::hmm_text(hmm, "fuzzed").empty(), "what is read can be written");
  });
}

static void use_profile(const std::string& path) {
  fuzz::accepts([&] {
    const auto profile = platform_sim::find_profile(path);
    if (!profile.recording) return;
    for (const double time : {0.0, 0.3, 1.0, 17.0, 600.0}) {
      const auto sample = profile.recording->at(time);
      fuzz::expect(sample.values.allFinite() && sample.velocities.allFinite(),
                   "a recorded motion is finite");
    }
  });
}

FUZZ_TARGET(motion_csv) { use_profile(fuzz::file_with(bytes, ".csv")); }

FUZZ_TARGET(motion_yaml) { use_profile(fuzz::file_with(bytes, ".yaml")); }

FUZZ_TARGET(robot_description) {
  fuzz::accepts([&] {
    const prf_ros::FrameTree tree(bytes.text());
    for (const auto& frame : tree.moving({"a", "b"}, {0.1, std::nan("")})) {
      fuzz::expect(!frame.child.empty() || frame.parent.empty(), "a frame has a name");
    }
  });
}
