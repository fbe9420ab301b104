#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Sets up the machine, builds everything and runs the tests.
# Usage: ./test.sh [PRESET]   (release, debug, sanitize; default release)
set -euo pipefail
cd "$(dirname "$0")"

preset=${1:-release}
scripts/build.sh "$preset"
# Some tests wait for clocks, sockets or a browser: two more than there are processors.
ctest --preset "$preset" --parallel "$(($(nproc) + 2))" --progress
