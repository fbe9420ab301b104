#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the formatting (clang-format), runs pyflakes over Python and clang-tidy over all sources.
# The whole tree takes most of an hour on two cores, read as the release preset joins it; --changed only
# what differs from the branch main of the origin (or from BASE), a changed header with a source that
# includes it by name.
# Usage: scripts/lint.sh [--changed [BASE] | FILE...]
set -euo pipefail
cd "$(dirname "$0")/.."

for tool in clang-format-16 clang-tidy-16 pyflakes3; do
  command -v "$tool" >/dev/null || { echo "install the Debian package $tool" >&2; exit 1; }
done
joined=OFF
[ $# -gt 0 ] || joined=ON
cmake --preset release -B build/lint -DKELPIE_JOIN_SOURCES=$joined >/dev/null
mapfile -t files < <(git ls-files '*.hpp' '*.cpp')
clang-format-16 --dry-run --Werror "${files[@]}"
git ls-files -z '*.py' | xargs -0 pyflakes3

# changed_sources BASE: sources that differ from BASE, and one that includes each changed header.
changed_sources() {
  local file
  git diff --name-only --diff-filter=d "$1" -- '*.cpp'
  while read -r file; do
    git grep -lF "$(basename "$(dirname "$file")")/$(basename "$file")\"" -- '*.cpp' | head -n 1
  done < <(git diff --name-only --diff-filter=d "$1" -- '*.hpp')
}

if [ "${1:-}" = --changed ]; then
  base=${2:-$(git merge-base HEAD origin/main 2>/dev/null || echo HEAD)}
  mapfile -t sources < <(changed_sources "$base" | sort -u)
elif [ $# -gt 0 ]; then
  sources=("$@")
else
  mapfile -t sources < <(/usr/bin/python3 -c '
import json
for entry in json.load(open("build/lint/compile_commands.json")): print(entry["file"])')
fi
# Not in the build that the linter reads: benchmarks and fuzzers, built only when asked for. And not
# C: the checks are for C++.
mapfile -t sources < <(printf '%s\n' "${sources[@]}" |
  grep -vE '^(lab/micro|tests/fuzz|tests/install)/|\.c$' || true)
[ ${#sources[@]} -gt 0 ] || exit 0
printf '%s\n' "${sources[@]}" |
  xargs -P "$(nproc)" -n 1 clang-tidy-16 -p build/lint --quiet --checks=-bugprone-suspicious-include \
    --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-unused-command-line-argument \
    2> >(grep -v "warnings generated" >&2 || true)
