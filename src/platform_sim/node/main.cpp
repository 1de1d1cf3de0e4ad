// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include <stdexcept>
#include <string>

#include "simulation.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "platform_sim");
  using platform_sim::Simulation;
  ros::NodeHandle node;
  Simulation::End end_reason = Simulation::End::kEnded;
  const int refused = prf_ros::run([&] {
    ros::NodeHandle private_node("~");
    std::string urdf;
    if (!node.getParam("robot_description", urdf)) {
      throw std::invalid_argument(node.resolveName("robot_description") +
                                  " is missing, must hold the URDF of the robot");
    }
    const platform_sim::SimParams params =
        platform_sim::load_params(prf_ros::PrivateParameters(private_node), node);
    end_reason = Simulation(node, private_node, params, urdf).run();
  });
  if (refused != 0) return refused;
  constexpr int kSilentExitCode = 5;  // 2 and 3 are prf_ros::run's
  return end_reason == Simulation::End::kSilent ? kSilentExitCode : 0;
}
