// SPDX-License-Identifier: BSD-3-Clause
// The readable YAML file of HMM parameters; see config/hmm_paper.yaml for its form.
#pragma once

#include <string>

#include "prf_decision/hmm.hpp"

namespace prf_decision {

// std::invalid_argument names the file, the key, the value and the bound.
[[nodiscard]] HmmParams load_hmm(const std::string& path);

// The file's text, every digit kept; `comment` goes above it, each line behind a '#'.
// Refuses parameters that load_hmm() would refuse.
[[nodiscard]] std::string hmm_text(const HmmParams& parameters, const std::string& comment);

}  // namespace prf_decision
