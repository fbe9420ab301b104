#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes the reader of bags with libFuzzer, from the corpus that is kept. What it finds on the way
# stays in build/fuzz/corpus; an input that breaks something is written to build/fuzz and named:
# once mended it belongs into tests/fuzz/corpus, where every test run goes through it.
# Usage: scripts/fuzz.sh [SECONDS]   (60); wants clang++-16, or another named by $CXX
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
cxx=${CXX:-clang++-16}
command -v "$cxx" >/dev/null || { echo "install the Debian package clang-16" >&2; exit 1; }
scripts/setup.sh
mkdir -p build/fuzz/corpus
log=build/fuzz.log
if ! { cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DKELPIE_BUILD_FUZZ=ON \
         -DKELPIE_BUILD_TESTS=OFF && ninja -C build/fuzz fuzz_bag; } >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
cd build/fuzz
if ! ./fuzz_bag -max_total_time="$seconds" -rss_limit_mb=512 -max_len=8192 -print_final_stats=1 \
     corpus ../../tests/fuzz/corpus ../../tests/bag/fixtures >"../../$log" 2>&1; then
  tail -n 60 "../../$log" >&2
  exit 1
fi
grep -E 'stat::(number_of_executed_units|peak_rss_mb)|^Done' "../../$log"
