// SPDX-License-Identifier: BSD-3-Clause
// Labels recorded motion by what the arm can do with it, and says how closely it can be held.
#include <ros/package.h>
#include <yaml-cpp/yaml.h>
#include <cmath>
#include <elte_planner/demonstration.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <prf_core/readable_file.hpp>
#include <prf_decision/motion_observer.hpp>
#include <prf_robots/robot.hpp>

#include "command.hpp"
#include "observed_run.hpp"

namespace prf_studies {
namespace {

using prf_decision::Intent;

constexpr char kRobot[] = "jaco_v60";  // of the demonstration

struct Task {
  std::vector<std::string> runs;
  std::string folder;
  std::string demonstration;
  std::string predictor = "periodic";
  std::string json;
  std::uint32_t seed = 1;
  AbilityParams ability;
};

std::string share_file(const std::string& package, const std::string& name) {
  const std::string folder = ros::package::getPath(package);
  if (folder.empty())
    throw std::invalid_argument("no package " + package +
                                " in ROS_PACKAGE_PATH: is a workspace sourced?");
  return folder + "/" + name;
}

prf_decision::ArmLimits configured_limits(const prf_robots::Robot& robot) {
  const std::string path = share_file("prf_decision", "config/decision.yaml");
  prf_core::require_readable_file(path);
  try {
    const YAML::Node limits = YAML::LoadFile(path)["arm_limits"];
    return {limits[0].as<double>(), limits[1].as<double>(), robot.kinematics};
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(path + " cannot be read as decision.yaml: " + error.what());
  }
}

void complete(Task& task) {
  if (task.demonstration.empty()) {
    task.demonstration = share_file("prf_experiments", "demonstrations/inspect_box.csv");
  }
  const auto robot = prf_robots::load_robot(prf_robots::robot_folder(kRobot));
  task.ability.arm = configured_limits(robot);
  task.ability.start = robot.ready;
  task.ability.goal_in_target =
      elte_planner::load_demonstration(task.demonstration).goal_in_target();
  task.ability.validate();
}

struct Judged {
  std::string path;
  ObservedRun run;
  Followed followed;
  std::vector<std::optional<Intent>> labels;

  [[nodiscard]] double share(Intent intent) const {
    double known = 0, found = 0;
    for (const auto& label : labels) {
      known += label ? 1 : 0;
      found += label == intent ? 1 : 0;
    }
    return known > 0 ? found / known : 0;
  }
};

Judged judge(const Task& task, const std::string& path) {
  Judged judged{path, {}, {}, {}};
  const bool is_bag = std::filesystem::path(path).extension() == ".bag";
  judged.run =
      is_bag ? run_from_bag(path)
             : run_from_motion(
                   path, share_file("prf_predictor", "config/target_predictor.yaml"),
                   share_file("prf_predictor", "config/predictors/" + task.predictor + ".yaml"),
                   task.seed);
  judged.followed = follow(judged.run, task.ability);
  judged.labels = labels(judged.run, judged.followed.instants, task.ability);
  return judged;
}

// One row for each forecast: what the HMM observes, and the label.
void write_table(const Judged& judged, const std::string& path) {
  std::ofstream file(path);
  file << "time_s,velocity_x,velocity_y,velocity_z,spread,deviation,label\n";
  prf_decision::MotionObserver observer;
  for (std::size_t k = 0; k < judged.labels.size(); ++k) {
    const prf_core::TargetForecast& forecast = judged.run.forecasts[k];
    char text[200];
    std::snprintf(text, sizeof(text), "%.4f",
                  prf_core::to_seconds(forecast.stamp - judged.run.forecasts[0].stamp));
    file << text;
    if (const auto seen = observer.observe(forecast)) {
      std::snprintf(text, sizeof(text), ",%.6f,%.6f,%.6f,%.6f", seen->velocity.x(),
                    seen->velocity.y(), seen->velocity.z(), seen->spread);
      file << text;
    } else {
      file << ",,,,";
    }
    const auto& deviation = judged.followed.observed[k];
    std::snprintf(text, sizeof(text), ",%.5f", deviation.value_or(0));
    const auto& label = judged.labels[k];
    file << (deviation ? text : ",") << ","
         << (label ? prf_decision::kIntentNames[static_cast<std::size_t>(*label)] : "none") << "\n";
  }
  file.close();
  if (!file)
    throw std::runtime_error(
        path + " cannot be written: is its folder there, and may this user write to it?");
}

// Beside a bag, where train_hmm --labels csv looks for it; else in the folder.
std::string table_of(const Task& task, const std::string& path) {
  const std::filesystem::path from(path);
  if (!task.folder.empty()) {
    return (std::filesystem::path(task.folder) / from.stem()).string() + ".csv";
  }
  if (from.extension() != ".bag") {
    throw std::invalid_argument(
        path + " is no bag, beside which labels are written: give a folder for them with --out");
  }
  return std::filesystem::path(from).replace_extension(".csv").string();
}

nlohmann::ordered_json figures_of(const Judged& judged, const AbilityParams& params) {
  nlohmann::ordered_json figures{{"run", judged.path}};
  for (const auto& [key, share] :
       {std::pair{"held_median_mm", 0.5}, {"held_p95_mm", 0.95}, {"held_largest_mm", 1.0}}) {
    figures[key] = 1e3 * held_within(judged.followed.instants, share, params);
  }
  for (const Intent intent : {Intent::kForward, Intent::kPause, Intent::kReverse}) {
    figures[std::string(prf_decision::kIntentNames[static_cast<std::size_t>(intent)]) +
            "_fraction"] = judged.share(intent);
  }
  return figures;
}

void print(const nlohmann::ordered_json& figures) {
  const auto number = [&](const char* key) { return figures[key].get<double>(); };
  std::printf("%s: this arm can hold %.0f mm here (95 %%: %.0f mm, median %.1f mm); ",
              figures["run"].get<std::string>().c_str(), number("held_largest_mm"),
              number("held_p95_mm"), number("held_median_mm"));
  std::printf("forward %.1f %%, pause %.1f %%, reverse %.1f %%\n", 100 * number("forward_fraction"),
              100 * number("pause_fraction"), 100 * number("reverse_fraction"));
  std::fflush(stdout);
}

void label(Task task, bool writes) {
  complete(task);
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& path : task.runs) {
    const Judged judged = judge(task, path);
    if (writes) write_table(judged, table_of(task, path));
    all.push_back(figures_of(judged, task.ability));
    print(all.back());
  }
  if (task.json.empty()) return;
  std::ofstream file(task.json);
  file << nlohmann::ordered_json{{"runs", all}}.dump(1) << "\n";
  if (!file)
    throw std::invalid_argument(
        "--json = " + task.json +
        " cannot be written: is its folder there, and may this user write to it?");
}

}  // namespace
}  // namespace prf_studies

int main(int argc, char** argv) {
  prf_studies::Task task;
  bool only_figures = false;
  CLI::App app(
      "Lets the arm's follower run against recorded motion and says how closely the hand stays at "
      "its goal. Labels each forecast forward, pause or reverse by the largest deviation within "
      "the horizon, in a table for train_hmm.",
      "label_motion");
  prf_studies::AbilityParams& ability = task.ability;
  app.add_option("RUN", task.runs, "bag with target/forecast, or table of record_motion")
      ->required();
  app.add_option("--out", task.folder, "folder for the tables [beside a bag, as .csv]");
  app.add_flag("--figures", only_figures, "write no tables");
  app.add_option("--clearance", ability.clearance, "m, of the task")->capture_default_str();
  app.add_option("--box-clearance", ability.box_clearance, "m, beyond it the hand may touch")
      ->capture_default_str();
  app.add_option("--horizon", ability.horizon, "s that a label looks ahead")->capture_default_str();
  app.add_option("--warm-up", ability.warm_up, "s without labels")->capture_default_str();
  app.add_option("--lead", ability.lead, "s, as in decision.yaml")->capture_default_str();
  app.add_option("--latency", ability.latency, "s, from image to command")->capture_default_str();
  app.add_option("--predictor", task.predictor, "of recorded motion")->capture_default_str();
  app.add_option("--seed", task.seed, "of the camera's noise")->capture_default_str();
  app.add_option("--demonstration", task.demonstration, "whose end is the hand's goal");
  app.add_option("--json", task.json, "write the figures to this file");
  return prf_studies::run_command(app, argc, argv,
                                  [&] { prf_studies::label(task, !only_figures); });
}
