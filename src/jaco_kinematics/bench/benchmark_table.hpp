// SPDX-License-Identifier: BSD-3-Clause
// Private to ik_benchmark: its arguments and what it prints.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace jaco_kinematics {

struct Options {
  std::string urdf = URDF_FILE;
  std::string json;
  int poses = 10000;
  unsigned seed = 1;
  bool help = false;
};

inline int whole_number(const std::string& name, const std::string& text, int least, int most) {
  std::size_t end = 0;
  int value = least - 1;
  try {
    value = std::stoi(text, &end);
  } catch (const std::exception&) {
  }
  if (end != text.size() || value < least || value > most) {
    throw std::invalid_argument(name + " is " + text + ", must be " + std::to_string(least) +
                                " .. " + std::to_string(most));
  }
  return value;
}

inline Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--help" || name == "-h") {
      std::puts(
          "usage: ik_benchmark [--poses N] [--seed N] [--urdf FILE] [--json FILE]\n"
          "Times the closed form and KDL's LMA and NR_JL on the same random reachable poses.");
      options.help = true;
      return options;
    }
    if (i + 1 == argc) throw std::invalid_argument(name + " lacks its value, or is unknown");
    const std::string value = argv[++i];
    if (name == "--poses") {
      options.poses = whole_number(name, value, 1, 1000000);
    } else if (name == "--seed") {
      options.seed = static_cast<unsigned>(whole_number(name, value, 0, 2147483647));
    } else if (name == "--urdf") {
      options.urdf = value;
    } else if (name == "--json") {
      options.json = value;
    } else {
      throw std::invalid_argument("unknown argument " + name);
    }
  }
  return options;
}

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

inline void write_json(const std::vector<Row>& rows, const Options& options) {
  std::ofstream file(options.json);
  file.precision(9);
  file << "{\"poses\": " << options.poses << ", \"seed\": " << options.seed << ", \"rows\": [";
  for (const Row& row : rows) {
    file << (&row == &rows.front() ? "\n" : ",\n") << " {\"solver\": \"" << row.solver
         << "\", \"solved_percent\": " << row.percent(row.solved)
         << ", \"met_percent\": " << row.percent(row.converged)
         << ", \"median_us\": " << row.quantile(0.5) << ", \"p99_us\": " << row.quantile(0.99)
         << ", \"max_position_error_m\": " << row.position_error
         << ", \"max_orientation_error_rad\": " << row.orientation_error << "}";
  }
  file << "\n]}\n";
  if (!file.flush()) throw std::invalid_argument("--json " + options.json + " cannot be written");
}

}  // namespace jaco_kinematics
