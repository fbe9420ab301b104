#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures which lines the tests run (gcovr, Debian package), in build/coverage; a table per building
# on the terminal, a page per file in build/coverage/html.
# Usage: scripts/coverage.sh [LABEL]   (library, logs, tools, live or lab; default: all of these)
set -euo pipefail
cd "$(dirname "$0")/.."

command -v gcovr >/dev/null || { echo "install the Debian package gcovr" >&2; exit 1; }
labels=${1:-library|logs|tools|live|lab}
scripts/setup.sh
cmake --preset release -B build/coverage -DCMAKE_CXX_FLAGS_RELEASE="-O1" \
  -DCMAKE_CXX_FLAGS="--coverage -fprofile-update=atomic" -DKELPIE_BUILD_PYTHON=OFF >/dev/null
cmake --build build/coverage
find build/coverage -name '*.gcda' -delete
ctest --test-dir build/coverage -L "^($labels)\$" --parallel "$(nproc)" --output-on-failure
mkdir -p build/coverage/html
gcovr --root . build/coverage --filter src/ --filter include/ --filter lab/ \
  --exclude-throw-branches --html-details build/coverage/html/index.html \
  --json-summary build/coverage/summary.json >/dev/null
/usr/bin/python3 - <<'END'
import json
from collections import defaultdict

lines, covered = defaultdict(int), defaultdict(int)
for file in json.load(open("build/coverage/summary.json"))["files"]:
    parts = file["filename"].split("/")
    building = {"include": "library", "lab": "lab"}.get(parts[0], parts[1])
    lines[building] += file["line_total"]
    covered[building] += file["line_covered"]
print("building      lines  covered")
for building in sorted(lines):
    print(f"{building:12s} {lines[building]:6d}   {100 * covered[building] / lines[building]:5.1f} %")
END
echo "Page: $PWD/build/coverage/html/index.html"
