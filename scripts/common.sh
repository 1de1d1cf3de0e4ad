# shellcheck shell=bash
# SPDX-License-Identifier: BSD-3-Clause
# Set-up and build shared by run_experiment and run_tests. Sourced, not run.
# Both steps do nothing when nothing is missing, so a second run starts at once.

repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=${BUILD_DIR:-$repo/build}
system_python=/usr/bin/python3
log_dir=$build_dir/log

say() { printf '[%s] %s\n' "$(date +%T)" "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

# Runs a command with its output in a log; shows where it stands, and the log's end if it fails.
quietly() {
  local what=$1 log=$log_dir/$2; shift 2
  mkdir -p "$log_dir" || die "cannot write to $log_dir"
  say "$what (log: $log)"
  set -m  # a process group of its own, so that Ctrl-C can end all of it
  "$@" >"$log" 2>&1 </dev/null &
  local job=$! started=$SECONDS last=''
  set +m
  # shellcheck disable=SC2064
  trap "kill -TERM -- -$job 2>/dev/null; wait $job 2>/dev/null; exit 130" INT TERM
  while kill -0 $job 2>/dev/null; do
    if [ -t 1 ]; then
      last=$(tail -c 400 "$log" | tr '\r' '\n' | grep -v '^ *$' | tail -n 1 | cut -c1-80)
      printf '\r\033[K  %3d s  %s' $((SECONDS - started)) "$last"
    fi
    sleep 0.5
  done
  [ -t 1 ] && printf '\r\033[K'
  local status=0; wait $job || status=$?
  trap - INT TERM
  if [ $status -ne 0 ]; then tail -n 30 "$log" >&2; die "$what failed (exit $status), whole log: $log"; fi
}

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null; then sudo "$@"
  else die "installing packages needs root or sudo: $*"; fi
}

listed() { sed 's/#.*//' "$1" | tr -s ' \n' '\n' | sed '/^$/d'; }

# install_debian_packages LIST: what a list of scripts/ names
install_debian_packages() {
  command -v apt-get >/dev/null || die "this needs Debian 12 or 13 (apt-get was not found)"
  local missing=() package
  for package in $(listed "$repo/scripts/$1"); do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  [ "$(id -u)" = 0 ] || as_root true  # asks for the password here, where it can be typed
  quietly "refreshing the package lists" apt-update.log as_root apt-get update
  quietly "installing ${#missing[@]} Debian packages" apt-install.log as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"
}

install_python_packages() {
  local stamp=$repo/.venv/installed.txt
  cmp -s "$repo/scripts/pip_packages.txt" "$stamp" && return
  [ -x "$repo/.venv/bin/pip" ] ||
    quietly "making the Python environment .venv" venv.log "$system_python" -m venv --system-site-packages "$repo/.venv"
  quietly "installing what Debian lacks from PyPI" pip.log "$repo/.venv/bin/pip" install -r "$repo/scripts/pip_packages.txt"
  cp "$repo/scripts/pip_packages.txt" "$stamp"
}

set_up() {
  install_debian_packages packages.txt
  install_python_packages
}

# build_workspace [target]: configures once, then builds what changed.
build_workspace() {
  if [ ! -f "$build_dir/build.ninja" ]; then
    quietly "configuring" cmake.log cmake -S "$repo" -B "$build_dir" -G Ninja \
      -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi
  quietly "building${1:+ $1}" build.log cmake --build "$build_dir" ${1:+--target "$1"}
}

source_workspace() {
  set +u  # catkin's script reads unset variables
  # shellcheck disable=SC1091
  . "$build_dir/devel/setup.bash" --extend || die "the workspace at $build_dir/devel cannot be sourced: remove $build_dir and build anew"
  set -u
}
