// SPDX-License-Identifier: BSD-3-Clause
// Prints the decision's state machine from its own table.
#include <cstdio>
#include <string>

#include "prf_decision/decision_fsm.hpp"

int main(int argc, char** argv) {
  const std::string option = argc == 2 ? argv[1] : "";
  if (argc > 2 || (argc == 2 && option != "--dot")) {
    std::fputs("usage: print_fsm [--dot]   Markdown table, or a Graphviz graph\n", stderr);
    return 2;
  }
  std::fputs((option == "--dot" ? prf_decision::fsm_dot() : prf_decision::fsm_markdown()).c_str(),
             stdout);
  return 0;
}
