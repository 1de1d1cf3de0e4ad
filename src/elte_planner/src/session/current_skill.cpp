// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/current_skill.hpp"

#include <filesystem>
#include <stdexcept>

namespace elte_planner {

CurrentSkill::CurrentSkill(const SessionParams& params, const std::string& demonstration,
                           const std::string& frame)
    : params_(params), first_(demonstration), frame_(frame) {
  load(first_);
}

void CurrentSkill::load(const std::string& file) {
  const auto type = std::filesystem::status(file).type();
  if (type != std::filesystem::file_type::regular &&
      type != std::filesystem::file_type::not_found) {
    throw std::invalid_argument(file + ": is no file");
  }
  const Demonstration demonstration = load_demonstration(file);
  if (demonstration.frame() != frame_) {
    throw std::invalid_argument("frame is '" + frame_ + "', must be '" + demonstration.frame() +
                                "' as in " + file);
  }
  session_ = std::make_unique<SkillSession>(params_, demonstration);
  file_ = file;
}

std::optional<std::string> CurrentSkill::select(const DemonstrationRequest& request) {
  if (request == current_) {
    refusal_.reset();
    return std::nullopt;
  }
  if (refusal_ && refusal_->request == request) return refusal_->reason;
  const auto folder = std::filesystem::path(first_).parent_path();
  try {
    load(request.file.empty() ? first_ : (folder / request.file).string());
  } catch (const std::invalid_argument& error) {
    refusal_ = Refusal{request, error.what()};
    return error.what();
  }
  current_ = request;
  refusal_.reset();
  return std::nullopt;
}

}  // namespace elte_planner
