// SPDX-License-Identifier: BSD-3-Clause
// Private to ik_benchmark: its rows, and how they are printed and written.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace jaco_kinematics {

struct BenchmarkParams {
  std::string urdf = URDF_FILE;
  std::string json;
  int poses = 10000;
  unsigned seed = 1;
};

struct Row {
  std::string solver;
  std::vector<double> times = {};  // us, one per pose
  int converged = 0;               // the pose is met, within limits or not
  int solved = 0;                  // within limits
  double position_error = 0;       // greatest of the solved, m
  double orientation_error = 0;    // rad

  double quantile(double share) const {
    std::vector<double> sorted = times;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
  double percent(int count) const { return 100.0 * count / static_cast<double>(times.size()); }

  void progress(std::size_t poses) const {
    if (times.size() % 500 != 0 || isatty(STDERR_FILENO) == 0) return;
    std::fprintf(stderr, "\r\033[K%s: %zu of %zu", solver.c_str(), times.size(), poses);
    if (times.size() == poses) std::fputs("\r\033[K", stderr);
  }
};

inline void print_table(const std::vector<Row>& rows) {
  std::printf("%-40s%10s%10s%11s%9s%11s%11s%12s\n", "solver", "solved %", "met %", "median us",
              "p99 us", "error m", "error rad", "times first");
  for (const Row& row : rows) {
    std::printf("%-40s%10.2f%10.2f%11.1f%9.1f%11.1e%11.1e%12.1f\n", row.solver.c_str(),
                row.percent(row.solved), row.percent(row.converged), row.quantile(0.5),
                row.quantile(0.99), row.position_error, row.orientation_error,
                row.quantile(0.5) / rows.front().quantile(0.5));
  }
}

inline void write_json(const std::vector<Row>& rows, const BenchmarkParams& params) {
  nlohmann::ordered_json out = {{"poses", params.poses}, {"seed", params.seed}};
  for (const Row& row : rows) {
    out["rows"].push_back({{"solver", row.solver},
                           {"solved_percent", row.percent(row.solved)},
                           {"met_percent", row.percent(row.converged)},
                           {"median_us", row.quantile(0.5)},
                           {"p99_us", row.quantile(0.99)},
                           {"max_position_error_m", row.position_error},
                           {"max_orientation_error_rad", row.orientation_error}});
  }
  std::ofstream file(params.json);
  file << out.dump(1) << '\n';
  if (!file.flush())
    throw std::invalid_argument(
        "--json " + params.json +
        " cannot be written: is its folder there, and may this user write to it?");
}

}  // namespace jaco_kinematics
