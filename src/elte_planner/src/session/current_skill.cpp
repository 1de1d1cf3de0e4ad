// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/current_skill.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "../demonstration/shown.hpp"

namespace elte_planner {
namespace {

namespace fs = std::filesystem;

// A pipe or a device would block the node or never end.
void require_file(const std::string& name, const std::string& real_file) {
  std::error_code error;
  const auto type = fs::status(real_file, error).type();
  if (type == fs::file_type::not_found || type == fs::file_type::none) return;  // said on opening
  if (type != fs::file_type::regular) {
    throw std::invalid_argument(name + ": is a folder, pipe or device, must be a file");
  }
  const auto size = fs::file_size(real_file, error);
  if (!error && size > kMaxDemonstrationBytes) {
    throw std::invalid_argument(name + ": has " + std::to_string(size) +
                                " bytes, must have at most " +
                                std::to_string(kMaxDemonstrationBytes));
  }
}

}  // namespace

CurrentSkill::CurrentSkill(const SessionParams& params, const SkillFiles& files)
    : params_(params),
      files_(files),
      folders_(files.demonstration, files.folders),
      current_(load({}, files.demonstration, files.demonstration)) {}

CurrentSkill::Skill CurrentSkill::load(const DemonstrationRequest& request, const std::string& file,
                                       const std::string& real_file) const {
  const std::string name = shown(file);
  require_file(name, real_file);
  std::ifstream stream(real_file);
  if (!stream) {
    std::error_code error;
    throw std::invalid_argument(name + (fs::exists(real_file, error)
                                            ? ": cannot be read: may this user read it?"
                                            : ": there is no such file"));
  }
  const Demonstration demonstration = read_demonstration(stream, name);
  if (demonstration.frame() != files_.frame) {
    throw std::invalid_argument("frame is '" + files_.frame + "', must be '" +
                                shown(demonstration.frame()) + "' as in " + name);
  }
  try {
    require_executable(demonstration, files_.limits);
  } catch (const std::invalid_argument& refusal) {
    throw std::invalid_argument(name + ": " + refusal.what());
  }
  return {request, file, std::make_unique<SkillSession>(params_, demonstration)};
}

CurrentSkill::Skill CurrentSkill::load_requested(const DemonstrationRequest& request) const {
  const std::string& first = files_.demonstration;
  if (request.file.empty()) return load(request, first, first);
  const std::string real_file = folders_.resolve(request.file);
  return load(request, (fs::path(first).parent_path() / request.file).string(), real_file);
}

std::optional<std::string> CurrentSkill::select(const DemonstrationRequest& request) {
  if (refusal_ && refusal_->request == request) return refusal_->reason;
  if (request == current_.request) {
    refusal_.reset();
    return std::nullopt;
  }
  if (previous_ && previous_->request == request) {
    std::swap(*previous_, current_);
  } else {
    try {
      previous_ = std::exchange(current_, load_requested(request));
    } catch (const std::invalid_argument& error) {
      refusal_ = Refusal{request, error.what()};
      return error.what();
    }
  }
  refusal_.reset();
  return std::nullopt;
}

void CurrentSkill::reset() {
  session().reset();
  if (previous_) previous_->session->reset();
}

}  // namespace elte_planner
