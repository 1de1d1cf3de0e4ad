// SPDX-License-Identifier: BSD-3-Clause
#include "simulation.hpp"

#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace platform_sim {
namespace {

constexpr std::int64_t kTickMs = 10;  // control period; that of the driver, where there is one
constexpr double kFallDelay = 1.0;    // s
// Nodes that were running before the clock went back drop the first ticks, so no response to these
// is insisted on.
constexpr std::int64_t kBeginMs = 100;
constexpr double kBeginPatience = 2.0;       // s of wall time
constexpr double kSettledConnections = 0.5;  // s of wall time without a new one
constexpr double kReportPeriod = 1.0;        // s of wall time
const ros::WallDuration kSpin(0.01);
const ros::WallDuration kLongestLag(0.05);   // behind the pace
const ros::WallDuration kLastMessages(0.5);  // for what is still under way when the run ends

void spin(const ros::WallDuration& longest) {
  ros::getGlobalCallbackQueue()->callAvailable(longest);
}

double seconds(std::int64_t milliseconds) { return 1e-3 * static_cast<double>(milliseconds); }

prf_core::Stamp stamp_at(std::int64_t now_ms) { return std::chrono::milliseconds(now_ms); }

double seconds_since(const ros::WallTime& begin) { return (ros::WallTime::now() - begin).toSec(); }

Peer peer_of(const SimParams& params) {
  return params.world.arm_mode == ArmMode::kServo ? Peer::kFramework : Peer::kGuide;
}

World make_world(const std::string& urdf, const WorldParams& config) {
  try {
    return World(urdf, config);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("robot_description: ") + error.what());
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "none" : text;
}

}  // namespace

Simulation::Simulation(ros::NodeHandle& node, ros::NodeHandle& private_node,
                       const SimParams& params, const std::string& urdf)
    : params_(params),
      tick_ms_(params.driver ? std::llround(1000.0 * params.driver->period) : kTickMs),
      world_(make_world(urdf, params.world)),
      camera_(urdf, world_.target(), params.camera),
      // The exposure of the first image does not begin before the simulation does.
      schedule_(params.camera.timing, std::max(kTickMs, tick_ms_)),
      publishers_(node, !params.driver, !params.world.disturb.empty()),
      responses_(node, peer_of(params), params.driver.has_value(), params.world.robot.arm_joints),
      start_service_(private_node.advertiseService("start", &Simulation::on_start, this)),
      started_(!params.paused) {
  if (params.driver) {
    driver_.emplace(node, *params.driver, params.world.robot.arm_joints,
                    [this] { heard_driver(); });
  }
  publishers_.publish_obstacles(world_.target());
  ROS_INFO("seed %s: %s", std::to_string(params.world.seed).c_str(), params.variation.c_str());
}

Simulation::End Simulation::run() {
  End end_reason = wait_for_start();
  if (end_reason != End::kEnded) return end_reason;
  begin_ = pace_ = last_report_ = ros::WallTime::now();
  while (!at_end()) {
    simulate_tick();
    publish_tick();
    end_reason = wait_for_responses();
    if (end_reason != End::kEnded) break;
    apply_responses();
    keep_pace();
    report_rate();
  }
  report_end();
  if (ros::ok()) kLastMessages.sleep();
  return end_reason;
}

bool Simulation::on_start(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = static_cast<unsigned char>(!started_);
  response.message = started_ ? "already started" : "starting";
  started_ = true;
  return true;
}

Simulation::End Simulation::wait_for_start() {
  const ros::WallTime begin = ros::WallTime::now();
  if (!started_)
    ROS_INFO("paused until the service %s is called", start_service_.getService().c_str());
  while (!started_ && ros::ok()) spin(kSpin);
  const End end_reason = params_.lockstep ? wait_for_connections() : End::kEnded;
  if (!ros::ok()) return End::kInterrupted;
  if (end_reason == End::kEnded) {
    ROS_INFO(
        "starting after %.1f s of waiting: scenario %s, motion %s, disturb '%s', gait %s, seed "
        "%lu, "
        "lockstep %s",
        seconds_since(begin), params_.world.scenario.c_str(), params_.world.motion.c_str(),
        params_.world.disturb.c_str(), params_.world.gait.c_str(), params_.world.seed,
        params_.lockstep ? "on" : "off");
  }
  return end_reason;
}

Simulation::End Simulation::wait_for_connections() {
  const bool camera_too = peer_of(params_) == Peer::kFramework;
  const ros::WallTime begin = ros::WallTime::now();
  ros::WallTime changed = begin;
  unsigned connections = 0;
  while (ros::ok()) {
    const unsigned count =
        publishers_.subscribers() + responses_.publishers() + (driver_ ? driver_->links() : 0);
    if (count != connections) changed = ros::WallTime::now();
    connections = count;
    std::vector<std::string> unread = publishers_.without_subscriber(camera_too);
    std::vector<std::string> without_sender = responses_.without_publisher();
    if (driver_ && !driver_->without_subscriber().empty()) {
      unread.push_back(driver_->without_subscriber());
    }
    if (driver_ && !driver_->without_publisher().empty()) {
      without_sender.push_back(driver_->without_publisher());
    }
    const bool complete = unread.empty() && without_sender.empty();
    if (complete && seconds_since(changed) > kSettledConnections) return End::kEnded;
    if (!complete && seconds_since(begin) > params_.response_timeout) {
      ROS_FATAL(
          "not connected within %.1f s of wall time; topics without publisher: %s; without "
          "subscriber: %s",
          params_.response_timeout, joined(without_sender).c_str(), joined(unread).c_str());
      return End::kSilent;
    }
    spin(kSpin);
  }
  return End::kInterrupted;
}

void Simulation::simulate_tick() {
  const ros::WallTime begin = ros::WallTime::now();
  for (std::int64_t i = 0; i < tick_ms_; ++i) {
    world_.step();
    ++now_ms_;
    if (schedule_.captures_at(now_ms_)) {
      schedule_.capture(now_ms_, {world_.frame("camera_optical_frame").pose, world_.platform().pose,
                                  world_.carrier().pose});
    }
  }
  physics_ += ros::WallTime::now() - begin;
}

// joint_states comes last: the framework responds to it.
void Simulation::publish_tick() {
  while (std::optional<camera_sim::Frame> frame = schedule_.take_exposed()) {
    images_.push_back({*frame, {}});
    begin_to_draw(images_.back());
  }
  publishers_.publish_clock(now_ms_);
  publish_due_images();
  publishers_.publish_ground_truth(now_ms_, world_);
  publishers_.publish_disturbances(now_ms_, world_);
  if (driver_) {
    driver_->publish(now_ms_, world_);
  } else {
    publishers_.publish_joint_states(now_ms_, world_);
  }
  responses_.lockstep().published_joint_states(stamp_at(now_ms_));
}

void Simulation::publish_due_images() {
  while (!images_.empty() && schedule_.is_due(images_.front().frame, now_ms_)) {
    Image& image = images_.front();
    begin_to_draw(image);
    if (image.picture.valid()) {
      const Picture picture = image.picture.get();
      rendering_ += picture.took;
      publishers_.publish_image(image.frame.stamp_ms, picture.pixels, camera_.optics());
      responses_.lockstep().published_image(stamp_at(image.frame.stamp_ms));
    }
    images_.pop_front();
  }
}

void Simulation::begin_to_draw(Image& image) {
  if (image.picture.valid() || !publishers_.image_is_wanted()) return;
  image.picture = std::async(std::launch::async, [this, &frame = image.frame] {
    const ros::WallTime begin = ros::WallTime::now();
    cv::Mat pixels = camera_.image(frame);
    return Picture{std::move(pixels), ros::WallTime::now() - begin};
  });
}

Simulation::End Simulation::wait_for_responses() {
  const ros::WallTime begin = ros::WallTime::now();
  double patience = params_.patience;
  if (patience == 0.0 && now_ms_ <= kBeginMs) patience = kBeginPatience;
  if (patience == 0.0 && now_ms_ > kBeginMs && now_ms_ <= kBeginMs + tick_ms_)
    responses_.lockstep().insist();
  spin(ros::WallDuration(0.0));
  while (params_.lockstep && !responses_.lockstep().is_complete()) {
    if (!ros::ok()) return End::kInterrupted;
    if (patience > 0.0 && seconds_since(begin) > patience) go_on(patience);
    if (seconds_since(begin) > params_.response_timeout) {
      const SilentTopic silent = *responses_.lockstep().first_silent();
      ROS_FATAL(
          "%s is silent: no response stamped %.3f s at tick %.3f s within %.1f s of wall time",
          topic_name(silent.response), prf_core::to_seconds(silent.stamp), seconds(now_ms_),
          params_.response_timeout);
      return End::kSilent;
    }
    spin(kSpin);
  }
  if (params_.lockstep && responses_.lockstep().goes_without()) {
    if (now_ms_ > kBeginMs) ++unanswered_;
    while (seconds_since(begin) < seconds(tick_ms_) && ros::ok()) spin(ros::WallDuration(0.001));
  }
  waiting_ += ros::WallTime::now() - begin;
  return ros::ok() ? End::kEnded : End::kInterrupted;
}

void Simulation::go_on(double patience) {
  std::vector<std::string> names;
  for (const Response response : responses_.lockstep().go_on()) {
    names.emplace_back(topic_name(response));
  }
  if (names.empty() || !going_on_.is_due()) return;
  ROS_WARN("tick %.3f s: goes on without %s after %.2f s of wall time", seconds(now_ms_),
           joined(names).c_str(), patience);
}

void Simulation::heard_driver() {
  if (now_ms_ == 0) return;
  [[maybe_unused]] const Receipt counted =
      responses_.lockstep().received(Response::kDriver, stamp_at(now_ms_));
}

void Simulation::apply_driver() {
  if (!driver_) return;
  if (driver_->take_halt()) world_.halt_driver();
  for (const DriverPoint& point : driver_->take()) world_.command_driver(point);
}

void Simulation::apply_responses() {
  apply_driver();
  if (const auto command = responses_.take_command()) {
    world_.command_arm(command->positions, command->velocities);
  }
  if (const auto wrench = responses_.take_wrench()) {
    world_.apply_hand_wrench(wrench->force, wrench->torque);
  }
}

void Simulation::keep_pace() {
  const double cap =
      params_.real_time_factor > 0.0 || params_.lockstep ? params_.real_time_factor : 1.0;
  if (cap <= 0.0) return;
  const ros::WallTime due = pace_ + ros::WallDuration(seconds(now_ms_) / cap);
  // Time lost is not made up for: a robot does not move faster after its computer was late.
  if (const ros::WallDuration late = ros::WallTime::now() - due; late > kLongestLag) pace_ += late;
  for (ros::WallTime now = ros::WallTime::now(); now < due && ros::ok();
       now = ros::WallTime::now()) {
    spin(std::min(due - now, kSpin));
  }
}

bool Simulation::at_end() {
  const auto end_after = [this](double delay) {
    const std::int64_t end = now_ms_ + std::llround(1000.0 * delay);
    end_ms_ = std::min(end, end_ms_.value_or(end));
  };
  if (responses_.finished() && !finished_) end_after(params_.end_delay);
  finished_ = responses_.finished();
  if (world_.fallen() && !fallen_) {
    const FrameState base = world_.base();
    const double tilt = std::acos(std::clamp(base.pose.linear()(2, 2), -1.0, 1.0));
    ROS_WARN("the robot fell at %.3f s: base %.2f m above the deck's centre, tilted by %.2f rad",
             seconds(now_ms_),
             base.pose.translation().z() - world_.platform().pose.translation().z(), tilt);
    end_after(kFallDelay);
  }
  fallen_ = world_.fallen();
  return seconds(now_ms_) >= params_.time_limit || now_ms_ >= end_ms_.value_or(now_ms_ + 1);
}

void Simulation::report_rate() {
  const ros::WallDuration since = ros::WallTime::now() - last_report_;
  if (since.toSec() < kReportPeriod) return;
  const double factor = seconds(now_ms_ - last_report_ms_) / since.toSec();
  publishers_.publish_diagnostics(now_ms_, factor, 1000.0 * factor / static_cast<double>(tick_ms_),
                                  responses_.refused() + (driver_ ? driver_->refused() : 0),
                                  unanswered_);
  last_report_ = ros::WallTime::now();
  last_report_ms_ = now_ms_;
}

void Simulation::report_end() const {
  const double wall = std::max(1e-9, seconds_since(begin_));
  ROS_INFO(
      "%.2f s simulated in %.2f s, real-time factor %.2f; physics %.0f %%, rendering %.0f %%, "
      "waiting for responses %.0f %%",
      seconds(now_ms_), wall, seconds(now_ms_) / wall, 100.0 * physics_.toSec() / wall,
      100.0 * rendering_.toSec() / wall, 100.0 * waiting_.toSec() / wall);
}

}  // namespace platform_sim
