// SPDX-License-Identifier: BSD-3-Clause
//
// The skill that is being executed: the session of one demonstration, begun anew when an execution
// requests another demonstration.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "elte_planner/demonstration_folders.hpp"
#include "elte_planner/demonstration_limits.hpp"
#include "elte_planner/skill_session.hpp"

namespace elte_planner {

struct SkillFiles {
  std::string demonstration;  // path of the first file
  std::string frame;          // the planning frame, which every demonstration must name
  DemonstrationLimits limits;
  std::string folders = {};  // where requested files may lie beside the first one's folder,
                             // separated by ':'
};

class CurrentSkill {
 public:
  // Throws std::invalid_argument when the first demonstration cannot be used.
  CurrentSkill(const SessionParams& params, const SkillFiles& files);

  // Makes the requested demonstration the current one. Its file is read when the request differs
  // from the current one and from the one before, also when only demonstration_switch differs. So
  // a request that comes by mistake costs no plan: the one before comes back with its own. When the
  // demonstration cannot be used, select() returns the reason, and the skill before it stays
  // current with its plan. A refused request that is repeated gives the same reason, without
  // reading the file again.
  [[nodiscard]] std::optional<std::string> select(const DemonstrationRequest& request);

  void reset();  // a new run: forgets all plans

  SkillSession& session() { return *current_.session; }
  const SkillSession& session() const { return *current_.session; }
  const std::string& demonstration() const { return current_.file; }  // the current one's file

 private:
  struct Skill {
    DemonstrationRequest request;
    std::string file;
    std::unique_ptr<SkillSession> session;
  };
  struct Refusal {
    DemonstrationRequest request;
    std::string reason;
  };

  // `real_file`: what to open for `file`.
  Skill load(const DemonstrationRequest& request, const std::string& file,
             const std::string& real_file) const;
  Skill load_requested(const DemonstrationRequest& request) const;

  SessionParams params_;
  SkillFiles files_;
  DemonstrationFolders folders_;
  Skill current_;
  std::optional<Skill> previous_;
  std::optional<Refusal> refusal_;
};

}  // namespace elte_planner
