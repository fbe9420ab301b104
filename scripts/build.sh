#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Sets up the machine and builds one preset (default: release), quiet unless something fails.
# Usage: scripts/build.sh [PRESET [TARGET...]]
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release}
shift || true
[ $# -gt 0 ] || set -- all
scripts/setup.sh "$preset"
mkdir -p build
log=build/$preset.log
echo "Building kelpie ($preset)"
if ! { cmake --preset "$preset" && cmake --build --preset "$preset" --target "$@"; } \
     >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
