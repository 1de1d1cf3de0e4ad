// SPDX-License-Identifier: BSD-3-Clause
#include "observed_run.hpp"

#include <prf_msgs/TargetForecast.h>
#include <rosbag/view.h>
#include <algorithm>
#include <memory>
#include <prf_ros/bag.hpp>
#include <prf_ros/conversions.hpp>
#include <stdexcept>

#include "predictor_file.hpp"
#include "recorded_motion.hpp"

namespace prf_studies {
namespace {

using prf_core::Stamp;
using prf_core::TargetForecast;
using prf_core::TargetStatus;

constexpr double kRate = 30.0;                                              // images per second
constexpr Stamp kStart = std::chrono::seconds(1);                           // a stamp is not 0
constexpr prf_core::Duration kLongestGap = std::chrono::milliseconds(100);  // of tracking
// s, as far ahead as an execution looks, and more.
const std::vector<double> kHorizons{0.0, 0.05, 0.1, 0.25};

TargetForecast forecast_of(const prf_predictor::TargetTracker& tracker,
                           const prf_predictor::TrackState& state) {
  TargetForecast forecast;
  forecast.stamp = state.stamp;
  forecast.status = state.status;
  if (state.belief) forecast.since_measurement = prf_core::from_seconds(state.since_accepted());
  forecast.predictions = tracker.forecast(state, kHorizons);
  forecast.measured_motion = state.measured_motion.at(state.stamp);
  return forecast;
}

// Between two forecasts of a tracked target, where it was at their stamps.
std::optional<prf_core::Pose> seen_at(const std::vector<TargetForecast>& tracked, Stamp time) {
  const auto after = std::lower_bound(
      tracked.begin(), tracked.end(), time,
      [](const TargetForecast& forecast, Stamp stamp) { return forecast.stamp < stamp; });
  if (after == tracked.end() || (after == tracked.begin() && after->stamp > time)) {
    return std::nullopt;
  }
  if (after->stamp == time) return after->predictions[0].target.pose;
  const auto before = after - 1;
  if (after->stamp - before->stamp > kLongestGap) return std::nullopt;
  return prf_core::interpolate(before->predictions[0].target, after->predictions[0].target,
                               prf_core::to_seconds(after->stamp - before->stamp),
                               prf_core::to_seconds(time - before->stamp))
      .pose;
}

}  // namespace

ObservedRun run_from_motion(const std::string& path, const std::string& node_file,
                            const std::string& predictor_file, std::uint32_t seed) {
  const auto motion =
      std::make_shared<RecordedMotion>(read_motion(path, {"time", "tag_x", "tag_y", "tag_z"}));
  if (motion->orientation.empty()) {
    throw std::invalid_argument(
        path +
        ": no columns tag_qx, tag_qy, tag_qz, tag_qw, must be there: record_motion writes them");
  }
  prf_predictor::TargetTracker tracker(read_tracker_params(node_file),
                                       read_predictor_file(predictor_file).make());
  ObservedRun run;
  for (const Image& image : simulate_images(*motion, kRate, seed)) {
    const auto result = tracker.process(kStart + image.stamp, image.measurements);
    run.forecasts.push_back(forecast_of(tracker, result.state));
  }
  run.truth = [motion](Stamp stamp) {
    return motion->at(motion->time.front() + prf_core::to_seconds(stamp - kStart));
  };
  return run;
}

ObservedRun run_from_bag(const std::string& path) {
  ObservedRun run;
  rosbag::Bag bag;
  prf_ros::open_bag(bag, path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    const auto forecast = prf_ros::message_in<prf_msgs::TargetForecast>(message);
    if (forecast) run.forecasts.push_back(prf_ros::to_core(*forecast));
  }
  if (run.forecasts.empty())
    throw std::invalid_argument(
        path + ": no message of target/forecast, `rosbag info` lists what it holds");
  auto tracked = std::make_shared<std::vector<TargetForecast>>();
  for (std::size_t i = 0; i < run.forecasts.size(); ++i) {
    if (i > 0 && run.forecasts[i].stamp <= run.forecasts[i - 1].stamp) {
      throw std::invalid_argument(path + ": the stamps of target/forecast do not rise at message " +
                                  std::to_string(i + 1) + ", must: was the bag of one run?");
    }
    if (run.forecasts[i].status == TargetStatus::kTracking) tracked->push_back(run.forecasts[i]);
  }
  run.truth = [tracked](Stamp stamp) { return seen_at(*tracked, stamp); };
  return run;
}

}  // namespace prf_studies
