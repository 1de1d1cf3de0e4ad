# shellcheck shell=bash
# SPDX-License-Identifier: BSD-3-Clause
# What the checks that run a tool share. Sourced, not run; leaves the shell in the repository's root.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 2
PATH=$PWD/.venv/bin:$PATH

# need TOOL LIST: a check whose tool is missing fails, it is never skipped.
need() {
  command -v "$1" >/dev/null && return
  echo "$1 is missing: scripts/$2 lists it, ./run_tests installs it" >&2
  exit 1
}
