// SPDX-License-Identifier: BSD-3-Clause
// Prints the decision's tables: the state machines and the guards.
#include <cstdio>
#include <string>

#include "prf_decision/decision_fsm.hpp"
#include "prf_decision/demonstration_switch.hpp"
#include "prf_decision/guards.hpp"

int main(int argc, char** argv) {
  using namespace prf_decision;
  const std::string option = argc == 2 ? argv[1] : "";
  if (argc > 2 || (argc == 2 && option != "--dot")) {
    std::fputs("usage: print_fsm [--dot]   Markdown tables, or a Graphviz graph\n", stderr);
    return 2;
  }
  const std::string tables = fsm_markdown() + "\n" + switch_markdown() + "\n" + guards_markdown();
  std::fputs((option == "--dot" ? fsm_dot() : tables).c_str(), stdout);
  return 0;
}
