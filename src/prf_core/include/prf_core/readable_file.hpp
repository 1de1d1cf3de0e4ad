// SPDX-License-Identifier: BSD-3-Clause
// What every reader of a user's file asks first.
#pragma once

#include <string>

namespace prf_core {

// Throws std::invalid_argument, with the path, unless there is a file of at most 200 MB: a folder
// or a stream that never ends is none.
void require_readable_file(const std::string& path);

}  // namespace prf_core
