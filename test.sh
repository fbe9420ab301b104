#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Sets up the machine, builds everything and runs the tests in two parts: first what the C++ targets
# of the five buildings show, then installation, pages in a browser, Python and the API reference.
# A failure in the first part ends the run. Suites `measured` and `nightly` have commands of their
# own (CONTRIBUTING.md).
# Usage: ./test.sh [PRESET]   (release, debug, sanitize; default release)
set -euo pipefail
cd "$(dirname "$0")"

preset=${1:-release}
second='^(installation|browser|python|docs)$'
# Some tests wait for clocks, sockets or a browser: two more than there are processors.
run_tests() { ctest --preset "$preset" --parallel "$(($(nproc) + 2))" --progress "$@"; }

scripts/build.sh "$preset" library logs tools live lab test_house
run_tests --label-exclude "$second|^(measured|nightly)\$"
scripts/build.sh "$preset"
run_tests --label-regex "$second"
