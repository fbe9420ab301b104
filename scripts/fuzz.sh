#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes what reads bytes of others, every target of tests/fuzz for some time, from the corpora that
# are kept there. What it finds on the way stays in build/fuzz/corpus_NAME; an input that breaks
# something is written to build/fuzz and named: once mended it belongs into tests/fuzz/corpus_NAME,
# which every test run goes through.
# Usage: scripts/fuzz.sh [SECONDS] [NAME...]   (60, all targets); wants clang++-16, or another named
# by $CXX. As many targets run at a time as there are processors.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
names=("${@:2}")
if [ ${#names[@]} -eq 0 ]; then
  mapfile -t names < <(printf '%s\n' tests/fuzz/corpus_* | sed 's/.*corpus_//')
fi
cxx=${CXX:-clang++-16}
command -v "$cxx" >/dev/null || { echo "install the Debian package clang-16" >&2; exit 1; }
scripts/setup.sh
mkdir -p build/fuzz
if ! { cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DKELPIE_BUILD_FUZZ=ON \
         -DKELPIE_BUILD_TESTS=OFF &&
         ninja -C build/fuzz "${names[@]/#/fuzz_}"; } >build/fuzz.log 2>&1; then
  cat build/fuzz.log >&2
  exit 1
fi

# fuzz NAME: what is new goes into the first corpus.
fuzz() {
  local corpora=("corpus_$1" "../../tests/fuzz/corpus_$1")
  [ "$1" != bag ] || corpora+=(../../tests/logs/bag/fixtures)
  mkdir -p "corpus_$1"
  # What was freed is kept aside, so that its use is seen: less of it, to stay below the limit.
  if ! ASAN_OPTIONS=quarantine_size_mb=64 "./fuzz_$1" -max_total_time="$seconds" \
       -rss_limit_mb=512 -max_len=8192 -print_final_stats=1 "${corpora[@]}" >"$1.log" 2>&1; then
    tail -n 60 "$1.log" >&2
    return 1
  fi
  echo "$1: $(grep -oE 'stat::number_of_executed_units: *[0-9]+' "$1.log" | grep -oE '[0-9]+$') inputs," \
    "at most $(grep -oE 'stat::peak_rss_mb: *[0-9]+' "$1.log" | grep -oE '[0-9]+$') MB"
}
export -f fuzz
export seconds
cd build/fuzz
printf '%s\n' "${names[@]}" | xargs -P "$(nproc)" -I{} bash -c 'fuzz {}'
