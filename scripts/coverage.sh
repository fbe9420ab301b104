#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures which lines the tests run (gcovr, Debian package), in build/coverage; a table per building
# and room on the terminal, a page per file in build/coverage/html. Inlined functions count where
# they are written.
# Usage: scripts/coverage.sh [LABEL]   (library, logs, tools, live or lab; default: all of these)
set -euo pipefail
cd "$(dirname "$0")/.."

command -v gcovr >/dev/null || { echo "install the Debian package gcovr" >&2; exit 1; }
read -ra labels <<<"${1:-library logs tools live lab}"
scripts/setup.sh
cmake --preset release -B build/coverage -DCMAKE_CXX_FLAGS_RELEASE="-O1" \
  -DCMAKE_CXX_FLAGS="--coverage -fprofile-update=atomic" -DKELPIE_BUILD_PYTHON=OFF >/dev/null
cmake --build build/coverage --target "${labels[@]}"
find build/coverage -name '*.gcda' -delete
ctest --test-dir build/coverage -L "^($(IFS='|'; echo "${labels[*]}"))\$" -E '_NOT_BUILT$' \
  --parallel "$(nproc)" --output-on-failure
mkdir -p build/coverage/html
gcovr --root . build/coverage --filter src/ --filter include/ --filter lab/ \
  --exclude-throw-branches \
  --html-details build/coverage/html/index.html --json-summary build/coverage/summary.json >/dev/null
/usr/bin/python3 - "${labels[@]}" <<'END'
import json
import sys
from collections import Counter

lines, covered = Counter(), Counter()
for file in json.load(open("build/coverage/summary.json"))["files"]:
    parts = file["filename"].split("/")
    building, room = {"include": ("library", parts[2:3]), "lab": ("lab", [])}.get(
        parts[0], (parts[1], parts[2:3]))
    for place in {building, "/".join([building, *room])}:
        if building in sys.argv:
            lines[place] += file["line_total"]
            covered[place] += file["line_covered"]
print(f"{'building or room':20s}   lines  covered")
for place in sorted(lines):
    print(f"{place:20s} {lines[place]:7d}   {100 * covered[place] / lines[place]:5.1f} %")
END
echo "Page: $PWD/build/coverage/html/index.html"
