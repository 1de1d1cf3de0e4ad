// SPDX-License-Identifier: BSD-3-Clause
// How the commands of this study end: a wrong argument or an exception is one line and exit code 2.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <functional>
#include <iostream>

namespace prf_studies {

inline int run_command(CLI::App& app, int argc, char** argv, const std::function<void()>& run) {
  constexpr int kUsageError = 2;
  try {
    app.parse(argc, argv);
    run();
    return EXIT_SUCCESS;
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << "\n";
    return kUsageError;
  }
}

}  // namespace prf_studies
