#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A learner renews a block without a pause while two threads predict by the exported C file
# (docs/howto/controller.md, "Swapped in place"): under ThreadSanitizer, or plain with PLAIN=1. Fails on a
# data race, and on an answer that is not the answer of its publication.
# Usage: block_race.sh BUILD MODEL.json [SECONDS [HERTZ]]       HERTZ 0: readers without a pause
set -euo pipefail

build=$(realpath "$1")
model=$(realpath "$2")
source=$(realpath "$(dirname "$0")/..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sanitizer=${PLAIN:+-O2}
sanitizer=${sanitizer:--O1 -g -fsanitize=thread}

cd "$work"
"$build/kelpie" export "$model" --live vehicle.so >/dev/null
"${CC:-cc}" -std=c99 $sanitizer -c vehicle.c
"${CXX:-c++}" -std=c++20 $sanitizer -I"$source/include" -I"$source/src/library" \
  -isystem /usr/include/eigen3 -DEigen=kelpie_eigen \
  "$source/tests/tools/format/block_race/race.cpp" \
  "$source/src/library/files/model_block.cpp" vehicle.o \
  -Wl,--allow-multiple-definition "$build/src/library/libkelpie.a" -lhwy -lm -o race
./race "$model" vehicle.block "${3:-60}" "${4:-100}"
