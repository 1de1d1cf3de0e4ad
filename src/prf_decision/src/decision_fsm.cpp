// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/decision_fsm.hpp"

#include <algorithm>
#include <sstream>

namespace prf_decision {
namespace {

constexpr std::array<const char*, kExecutionStates> kExecutionStateNames{
    "waiting", "forward", "pause", "reverse", "tracking", "retract", "done", "stopped", "search"};
constexpr std::array<const char*, kStates> kStateNames{
    "idle",     "waiting", "rewind waiting", "forward", "pause",   "reverse", "rewinding",
    "tracking", "retract", "leaving",        "done",    "stopped", "search"};
constexpr std::array<const char*, kEvents> kEventNames{
    "calm",    "unsteady", "unstable",  "clear", "hazard",    "overdue",
    "missing", "lost",     "give up",   "away",  "time up",   "complete",
    "held",    "at start", "preempted", "begin", "begin away"};

std::string label(const Row& row) {
  return std::string(name(row.event)) + (row.condition == Condition::kDwelled ? " [dwelled]" : "");
}

std::string node(State state) {
  std::string text = name(state);
  std::replace(text.begin(), text.end(), ' ', '_');
  return text;
}

}  // namespace

const char* name(ExecutionState state) {
  return kExecutionStateNames[static_cast<std::size_t>(state)];
}
const char* name(State state) { return kStateNames[static_cast<std::size_t>(state)]; }
const char* name(Event event) { return kEventNames[static_cast<std::size_t>(event)]; }

std::string fsm_markdown() {
  std::ostringstream table;
  table << "| state | published | event → next |\n|---|---|---|\n";
  for (std::size_t i = 0; i < kStates; ++i) {
    const auto state = static_cast<State>(i);
    table << "| " << name(state) << " | " << name(published(state)) << " | ";
    const char* separator = "";
    for (const Row& row : kTable) {
      if (row.from != state) continue;
      table << separator << label(row) << " → " << name(row.to);
      separator = ", ";
    }
    table << " |\n";
  }
  return table.str();
}

std::string fsm_dot() {
  std::ostringstream graph;
  graph << "digraph decision {\n  rankdir=LR;\n  node [shape=box, style=rounded];\n"
        << "  idle [penwidth=2];\n  done [peripheries=2];\n  stopped [peripheries=2];\n";
  for (const Row& row : kTable) {
    graph << "  " << node(row.from) << " -> " << node(row.to) << " [label=\"" << label(row)
          << "\"];\n";
  }
  graph << "}\n";
  return graph.str();
}

}  // namespace prf_decision
