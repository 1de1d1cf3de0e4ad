// SPDX-License-Identifier: BSD-3-Clause
//
// The skill that is followed: the session of one demonstration, begun anew when another is wanted.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "elte_planner/skill_session.hpp"

namespace elte_planner {

class FollowedSkill {
 public:
  // Throws std::invalid_argument when the first demonstration cannot be followed.
  FollowedSkill(const SessionParams& params, const std::string& demonstration,
                const std::string& frame);

  // Why `wanted` cannot be followed: what was followed before stays. Nothing: it is followed. A
  // file is read when what is wanted changes: the same name under a new number is read anew.
  [[nodiscard]] std::optional<std::string> follow(const WantedSkill& wanted);

  SkillSession& session() { return *session_; }
  const SkillSession& session() const { return *session_; }
  const std::string& demonstration() const { return file_; }  // the file followed

 private:
  struct Refusal {
    WantedSkill wanted;
    std::string reason;
  };

  void load(const std::string& file);

  SessionParams params_;
  std::string first_;
  std::string frame_;
  std::string file_;
  std::unique_ptr<SkillSession> session_;
  WantedSkill followed_;
  std::optional<Refusal> refusal_;
};

}  // namespace elte_planner
