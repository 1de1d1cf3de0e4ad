// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/decision_fsm.hpp"

#include <sstream>

namespace prf_decision {
namespace {

constexpr std::array<const char*, kStates> kStateNames{"waiting",  "forward", "pause", "reverse",
                                                       "tracking", "retract", "done",  "stopped"};
constexpr std::array<const char*, kEvents> kEventNames{
    "calm",    "unsteady", "unstable", "hazard", "overdue",  "lost",
    "time up", "complete", "held",     "rewind", "preempted"};

std::string label(const Row& row) {
  return std::string(name(row.event)) + (row.guard == Guard::kDwelled ? " [dwelled]" : "");
}

}  // namespace

const char* name(State state) { return kStateNames[static_cast<std::size_t>(state)]; }

const char* name(Event event) { return kEventNames[static_cast<std::size_t>(event)]; }

std::string fsm_markdown() {
  std::ostringstream table;
  table << "| state | event | next |\n|---|---|---|\n";
  for (const Row& row : kTable) {
    table << "| " << name(row.from) << " | " << label(row) << " | " << name(row.to) << " |\n";
  }
  return table.str();
}

std::string fsm_dot() {
  std::ostringstream graph;
  graph << "digraph decision {\n  rankdir=LR;\n  node [shape=box, style=rounded];\n"
        << "  waiting [penwidth=2];\n  done [peripheries=2];\n  stopped [peripheries=2];\n";
  for (const Row& row : kTable) {
    graph << "  " << name(row.from) << " -> " << name(row.to) << " [label=\"" << label(row)
          << "\"];\n";
  }
  graph << "}\n";
  return graph.str();
}

}  // namespace prf_decision
