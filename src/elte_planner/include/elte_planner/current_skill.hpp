// SPDX-License-Identifier: BSD-3-Clause
//
// The skill that is being executed: the session of one demonstration, begun anew when an execution
// requests another demonstration.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "elte_planner/skill_session.hpp"

namespace elte_planner {

class CurrentSkill {
 public:
  // `demonstration`: path of the first file. `frame`: the planning frame, which every demonstration
  // must name. Throws std::invalid_argument when the first demonstration cannot be used.
  CurrentSkill(const SessionParams& params, const std::string& demonstration,
               const std::string& frame);

  // Makes the requested demonstration the current one. Its file is read when the request differs
  // from the current one, also when only demonstration_switch differs. When the demonstration
  // cannot be used, select() returns the reason, and the skill before it stays current with its
  // plan. A refused request that is repeated gives the same reason, without reading the file again.
  [[nodiscard]] std::optional<std::string> select(const DemonstrationRequest& request);

  SkillSession& session() { return *session_; }
  const SkillSession& session() const { return *session_; }
  const std::string& demonstration() const { return file_; }  // the current one's file

 private:
  struct Refusal {
    DemonstrationRequest request;
    std::string reason;
  };

  void load(const std::string& file);

  SessionParams params_;
  std::string first_;
  std::string frame_;
  std::string file_;
  std::unique_ptr<SkillSession> session_;
  DemonstrationRequest current_;
  std::optional<Refusal> refusal_;
};

}  // namespace elte_planner
