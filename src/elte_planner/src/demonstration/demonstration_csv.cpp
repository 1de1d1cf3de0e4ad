// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <prf_core/table.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "elte_planner/demonstration.hpp"
#include "shown.hpp"

namespace elte_planner {
namespace {

constexpr std::string_view kHeader = "time,x,y,z,qx,qy,qz,qw";
constexpr std::array<const char*, 8> kColumns = {"time", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::array<const char*, 7> kPoseFields = {"x", "y", "z", "qx", "qy", "qz", "qw"};

std::string_view trimmed(std::string_view text) {
  const char* const blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// What has been read so far, and where, so that every refusal says file and line.
class Reader {
 public:
  Reader(std::istream& in, const std::string& name)
      : table_(in, name, [this](std::string_view comment) { take_metadata(comment); }),
        name_(name) {}

  Demonstration read() {
    while (table_.next()) take_row_or_header();
    if (!has_header_) refuse_file("has no header line '" + std::string(kHeader) + "'");
    for (const char* key : {"frame", "child_frame", "target_pose"}) {
      if (notes_.count(key) == 0) refuse_file("has no line '# " + std::string(key) + ": ...'");
    }
    const std::string frame = notes_.extract("frame").mapped();
    const std::string child_frame = notes_.extract("child_frame").mapped();
    notes_.erase("target_pose");
    try {
      return Demonstration(samples_, frame, child_frame, target_, notes_);
    } catch (const std::invalid_argument& error) {
      refuse_file(error.what());
    }
  }

 private:
  void take_row_or_header() {
    if (has_header_) return take_row();
    has_header_ =
        std::equal(table_.cells().begin(), table_.cells().end(), kColumns.begin(), kColumns.end());
    if (!has_header_) {
      refuse("header is '" + shown(trimmed(table_.text()), 60) + "', must be '" +
             std::string(kHeader) + "'");
    }
  }

  void take_metadata(std::string_view line) {
    const auto colon = line.find(':');
    if (colon == std::string_view::npos) return;
    const std::string key(trimmed(line.substr(0, colon)));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!notes_.emplace(key, value).second) refuse("key '" + shown(key, 60) + "' is given twice");
    if (key == "target_pose") target_ = target_pose(value);
  }

  Pose target_pose(std::string_view value) const {
    std::array<double, 7> number{};
    std::istringstream words{std::string(value)};
    std::string word;
    std::size_t count = 0;
    for (; words >> word; ++count) {
      if (count < number.size()) number[count] = number_from(word, kPoseFields[count]);
    }
    if (count != number.size()) {
      refuse("target_pose has " + std::to_string(count) + " numbers, must have 7");
    }
    return pose(number.data());
  }

  void take_row() {
    const std::vector<std::string>& fields = table_.cells();
    if (fields.size() != kColumns.size()) {
      refuse("has " + std::to_string(fields.size()) + " columns, must have " +
             std::to_string(kColumns.size()));
    }
    std::array<double, 8> number{};
    for (std::size_t i = 0; i < number.size(); ++i) {
      const auto value = table_.value(i);
      if (!value) refuse_number(fields[i], kColumns[i]);
      number[i] = *value;
    }
    check_time(number[0]);
    samples_.push_back({number[0], pose(&number[1])});
  }

  void check_time(double time) const {
    if (samples_.empty()) {
      if (time != 0.0) refuse("column 'time' is " + std::to_string(time) + ", must start at 0");
    } else if (!(time > samples_.back().time)) {
      refuse("column 'time' is " + std::to_string(time) + ", must be above " +
             std::to_string(samples_.back().time) + " of the row before");
    }
  }

  Pose pose(const double* xyz_qxyzw) const {
    const Eigen::Quaterniond orientation(xyz_qxyzw[6], xyz_qxyzw[3], xyz_qxyzw[4], xyz_qxyzw[5]);
    const double norm = orientation.norm();
    if (!(std::abs(norm - 1.0) <= prf_core::kUnitQuaternionTolerance)) {
      refuse("columns 'qx' to 'qw' have norm " + std::to_string(norm) + ", must be within " +
             std::to_string(prf_core::kUnitQuaternionTolerance) + " of 1");
    }
    return {{xyz_qxyzw[0], xyz_qxyzw[1], xyz_qxyzw[2]}, orientation};
  }

  double number_from(std::string_view field, const char* column) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
      refuse_number(field, column);
    }
    return value;
  }

  [[noreturn]] void refuse_number(std::string_view field, const char* column) const {
    refuse("column '" + std::string(column) + "' is '" + shown(field, 60) +
           "', must be a finite number");
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(name_ + ":" + std::to_string(table_.line()) + ": " + what);
  }

  [[noreturn]] void refuse_file(const std::string& what) const {
    throw std::invalid_argument(name_ + ": " + what);
  }

  prf_core::TableReader table_;
  std::string name_;
  bool has_header_ = false;
  Demonstration::Notes notes_;  // every `# key: value` line
  Pose target_;
  std::vector<TimedPose> samples_;
};

void write(const Demonstration& demonstration, std::ostream& out) {
  const auto numbers = [&out](const Pose& pose, const char* separator) {
    const Eigen::Vector3d& p = pose.position;
    const Eigen::Quaterniond& q = pose.orientation;
    out << p.x();
    for (const double number : {p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) {
      out << separator << number;
    }
    out << '\n';
  };
  out << std::fixed << std::setprecision(9);
  for (const auto& [key, value] : demonstration.notes())
    out << "# " << key << ": " << value << '\n';
  out << "# frame: " << demonstration.frame() << '\n'
      << "# child_frame: " << demonstration.child_frame() << "\n# target_pose: ";
  numbers(demonstration.target(), " ");
  out << kHeader << '\n';
  for (const TimedPose& sample : demonstration.samples()) {
    out << std::setprecision(6) << sample.time << ',' << std::setprecision(9);
    numbers(sample.pose, ",");
  }
}

}  // namespace

Demonstration load_demonstration(const std::string& path) {
  std::ifstream file = prf_core::open_table(path);
  return read_demonstration(file, path);
}

Demonstration read_demonstration(std::istream& in, const std::string& name) {
  return Reader(in, name).read();
}

void save_demonstration(const Demonstration& demonstration, const std::string& path) {
  std::stringstream text;
  write(demonstration, text);
  if (read_demonstration(text, path).notes() != demonstration.notes()) {
    throw std::invalid_argument(path +
                                ": notes cannot hold line breaks, blanks at their ends or a ':' "
                                "in the key");
  }
  std::ofstream file(path);
  file << text.str();
  if (!file.flush())
    throw std::invalid_argument(
        path + ": cannot be written: is its folder there, and may this user write to it?");
}

}  // namespace elte_planner
