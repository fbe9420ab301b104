#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes the readers of bags, of .tlog files and of MAVLink, and who may see the live page, with
# libFuzzer, a quarter of the time each, from the corpora that are kept. What it finds on the way
# stays in build/fuzz/corpus…; an input that breaks something is written to build/fuzz and named:
# once mended it belongs into the folder of that name in tests/fuzz, where every test run goes
# through it.
# Usage: scripts/fuzz.sh [SECONDS]   (60); wants clang++-16, or another named by $CXX
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
cxx=${CXX:-clang++-16}
command -v "$cxx" >/dev/null || { echo "install the Debian package clang-16" >&2; exit 1; }
scripts/setup.sh
mkdir -p build/fuzz/corpus build/fuzz/corpus_tlog build/fuzz/corpus_mavlink build/fuzz/corpus_web
log=build/fuzz.log
if ! { cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DKELPIE_BUILD_FUZZ=ON \
         -DKELPIE_BUILD_TESTS=OFF &&
         ninja -C build/fuzz fuzz_bag fuzz_tlog fuzz_mavlink fuzz_web; } >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
cd build/fuzz
# fuzz TARGET CORPUS...: what is new goes into the first corpus.
fuzz() {
  # What was freed is kept aside, so that its use is seen: less of it, to stay below the limit.
  if ! ASAN_OPTIONS=quarantine_size_mb=64 "./$1" -max_total_time=$((seconds / 4)) -rss_limit_mb=512 -max_len=8192 \
       -print_final_stats=1 "${@:2}" >"../../$log" 2>&1; then
    tail -n 60 "../../$log" >&2
    exit 1
  fi
  echo "$1"
  grep -E 'stat::(number_of_executed_units|peak_rss_mb)|^Done' "../../$log"
}
fuzz fuzz_bag corpus ../../tests/fuzz/corpus ../../tests/bag/fixtures
fuzz fuzz_tlog corpus_tlog ../../tests/fuzz/corpus_tlog
fuzz fuzz_mavlink corpus_mavlink ../../tests/fuzz/corpus_mavlink
fuzz fuzz_web corpus_web ../../tests/fuzz/corpus_web
