// SPDX-License-Identifier: BSD-3-Clause
// What elte_planner takes from messages. Whatever came before, a few good messages bring a plan.
#include <prf_ros/conversions.hpp>

#include "../../elte_planner/node/conversions.hpp"
#include "elte_planner/obstacle_history.hpp"
#include "elte_planner/request_queue.hpp"
#include "elte_planner/skill_session.hpp"
#include "fuzz_target.hpp"

namespace {

using namespace elte_planner;

constexpr int kNodes = 12;

SkillSession session() {
  std::vector<TimedPose> samples;
  for (int i = 0; i <= 20; ++i) {
    const double s = 0.05 * i;
    samples.push_back({s,
                       {{0.3 + 0.3 * s, 0.1 * std::sin(3.0 * s), 0.2 + 0.2 * s * s},
                        Eigen::Quaterniond::Identity()}});
  }
  SessionParams params;
  params.planner = "elte";
  params.nodes = kNodes;
  params.horizon_max = 2.0;
  params.confidence = 0.5;
  params.radius_max = 0.02;
  params.approach_length = 0.2;
  return {params, Demonstration(samples, "arm", "hand", Pose{{1.0, 0.0, 0.5}, {1, 0, 0, 0}})};
}

SkillSession& shared_session() {  // it takes long to make
  static SkillSession made = session();
  made.reset();
  return made;
}

struct Planner {
  RequestQueue queue;
  ObstacleHistory obstacles;
  SkillSession& skill = shared_session();
  bool planned = false;

  void drain() {
    while (const auto request = queue.next()) {
      if (request->new_run) {
        skill.reset();
        obstacles.begin_run(request->progress.stamp);
      }
      const auto result =
          skill.plan(request->progress, request->forecast ? &*request->forecast : nullptr,
                     obstacles.at(request->progress.stamp));
      planned = result.status == SkillStatus::kSolved || result.status == SkillStatus::kRelaxed;
      for (const TimedPose& node : result.poses) {
        fuzz::expect(node.pose.is_finite(), "a plan is finite");
      }
      (void)prf_ros::to_ros_time(request->progress.stamp);
      (void)prf_ros::to_ros_time(request->progress.forecast_stamp);
    }
  }
};

prf_core::TargetForecast good_forecast(prf_core::Stamp stamp) {
  prf_core::TargetForecast forecast;
  forecast.stamp = stamp;
  forecast.status = prf_core::TargetStatus::kTracking;
  forecast.predictions.resize(1);
  forecast.predictions[0].target.pose = Pose{{1.0, 0.05, 0.5}, {1, 0, 0, 0}};
  return forecast;
}

}  // namespace

FUZZ_TARGET(planner_messages) {
  Planner planner;
  fuzz::for_each_message(bytes, [&](int kind, fuzz::Bytes part) {
    fuzz::accepts([&] {
      prf_msgs::TargetForecast forecast;
      prf_msgs::ExecutionProgress progress;
      visualization_msgs::MarkerArray markers;
      if (kind % 3 == 0 && fuzz::read(part, forecast)) {
        planner.queue.add(forecast_from(forecast).first);
      } else if (kind % 3 == 1 && fuzz::read(part, progress)) {
        const Progress asked = progress_from(progress);
        asked.validate(kNodes);
        planner.queue.add(asked);
      } else if (kind % 3 == 2 && fuzz::read(part, markers)) {
        auto [stamp, obstacles] = obstacles_from(markers, "j2s7s300_link_base", "tag_0");
        planner.obstacles.add(stamp, std::move(obstacles));
      }
    });
    planner.drain();
  });
  planner.planned = false;
  planner.obstacles = {};  // they may block the way
  for (int i = 0; i < 8 && !planner.planned; ++i) {
    const prf_core::Stamp stamp = std::chrono::hours(100) + std::chrono::milliseconds(33 * i);
    planner.queue.add(good_forecast(stamp));
    planner.queue.add(Progress{stamp, stamp, 2, std::chrono::seconds(1), {}});
    planner.drain();
  }
  fuzz::expect(planner.planned, "good messages bring a plan after whatever came before");
}
