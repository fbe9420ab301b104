#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the formatting (clang-format), runs pyflakes over Python and clang-tidy over all sources.
# Takes some minutes.
# Usage: scripts/lint.sh [FILE...]
set -euo pipefail
cd "$(dirname "$0")/.."

for tool in clang-format-16 clang-tidy-16 pyflakes3; do
  command -v "$tool" >/dev/null || { echo "install the Debian package $tool" >&2; exit 1; }
done
cmake --preset release -B build/lint -DKELPIE_JOIN_SOURCES=OFF >/dev/null  # one by one
mapfile -t files < <(git ls-files '*.hpp' '*.cpp')
clang-format-16 --dry-run --Werror "${files[@]}"
git ls-files -z '*.py' | xargs -0 pyflakes3
if [ $# -gt 0 ]; then
  sources=("$@")
else
  mapfile -t sources < <(git ls-files '*.cpp' ':!bench')  # built only when asked for
fi
printf '%s\n' "${sources[@]}" |
  xargs -P "$(nproc)" -n 4 clang-tidy-16 -p build/lint --quiet \
    --extra-arg=-Wno-unknown-warning-option 2> >(grep -v 'warnings generated' >&2 || true)
