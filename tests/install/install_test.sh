#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs a build tree into a folder of its own and uses kelpie from there as others would.
# Usage: install_test.sh SOURCE BUILD VERSION CXX "CXX FLAGS" [all]
set -euo pipefail

source=$1 build=$2 version=$3 cxx=$4 flags=$5 all=${6:-}
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
prefix=$stage/usr

fail() {
  echo "FAILED: $1" >&2
  [ -f "$stage/log" ] && cat "$stage/log" >&2
  exit 1
}

# run COMMAND...: quiet unless it fails.
run() { "$@" >"$stage/log" 2>&1 || fail "$*"; }

# consumer FOLDER OPTION...: configures the consumer.
consumer() {
  local folder=$1
  shift
  cmake -S "$source/tests/install/consumer" -B "$stage/$folder" -G Ninja \
    -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_CXX_FLAGS="$flags" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCONSUMER_SOURCE="$source/examples/01_learner.cpp" "$@"
}

# refused WORDS OPTION...: the consumer is told WORDS.
refused() {
  local words=$1
  shift
  if consumer refused "$@" >"$stage/log" 2>&1; then fail "accepted: $*"; fi
  tr -s ' \n' ' ' <"$stage/log" | grep -qF "$words" || fail "no word of '$words' with $*"
  rm -rf "$stage/refused"
}

# too_old WORDS COMMAND...: kelpie itself is refused, by WORDS, by what is older than it wants.
too_old() {
  local words=$1
  shift
  if "$@" -S "$source" -B "$stage/old" >"$stage/log" 2>&1; then fail "accepted: $*"; fi
  tr -s ' \n' ' ' <"$stage/log" | grep -qF "$words" || fail "no word of '$words' with $*"
  rm -rf "$stage/old"
}
printf '#!/bin/sh\nexec g++ -U__GNUC__ -D__GNUC__=10 "$@"\n' >"$stage/gcc_10"
chmod +x "$stage/gcc_10"
too_old "kelpie needs GCC 11 or Clang 16" cmake -DCMAKE_CXX_COMPILER="$stage/gcc_10"
too_old "kelpie needs Highway 1.0 or newer" env PKG_CONFIG_LIBDIR=/nowhere PKG_CONFIG_PATH= cmake

run cmake --install "$build" --prefix "$prefix"
# Nothing that is installed may know where it was built.
if grep -rlIF -e "$build" -e "$source" "$prefix" >"$stage/log"; then fail "paths of the build"; fi
[ "$("$prefix/bin/kelpie" --version)" = "kelpie $version" ] || fail "the installed command"
manual=()
if command -v help2man >/dev/null; then manual=(man1/kelpie.1.gz); fi
for file in "${manual[@]/#/man/}" bash-completion/completions/kelpie kelpie/scenarios/small.toml; do
  [ -s "$prefix/share/$file" ] || fail "no $file"
done
if [ -x "$prefix/bin/kelpie-lab" ]; then  # it finds its scenarios, wherever it stands
  (cd "$stage" && "$prefix/bin/kelpie-lab" reproduce --scenario none --out lab) >"$stage/log" 2>&1 ||
    grep -qF "$prefix/share/kelpie/scenarios: 'none' is no scenario; there are aba" "$stage/log" ||
    fail "kelpie-lab doesn't find its scenarios"
fi
grep -q "<version>$version</version>" "$prefix/share/kelpie/package.xml" ||
  fail "package.xml is of another version"

# CMake
run consumer cmake -DKELPIE_WANTED="${version%.*}" -DKELPIE_COMPONENTS="library;logs"
run cmake --build "$stage/cmake"
"$stage/cmake/consumer" | tee "$stage/by_cmake" | grep -q 'R² of the last 1000 predictions: 0\.9' ||
  fail "the consumer learns nothing"
[ "$("$stage/cmake/logs_consumer" "$source/tests/logs/bag/fixtures/zstd.mcap")" = "24 messages" ] ||
  fail "the consumer of kelpie-logs reads no bag"
refused 'requested version "99"' -DKELPIE_WANTED=99
refused "no component 'pyhton'; this installation has: library, logs" -DKELPIE_COMPONENTS=pyhton

# A model.json, read without the tools that wrote it
run "$prefix/bin/kelpie" simulate "$prefix/share/kelpie/scenarios/small.toml" --out "$stage/small.csv"
run "$prefix/bin/kelpie" learn "$stage/small.csv" --out "$stage/learned" --set buffer=60
place=(0.4 0.02 -0.1 8 7 3)
"$stage/cmake/model_json" "$stage/learned/model.json" "${place[@]}" | tee "$stage/model_by_cmake" |
  grep -qE '^vdot -?[0-9]' || fail "no model.json is read in C++"
if "$stage/cmake/model_json" "$stage/small.csv" "${place[@]}" 2>"$stage/log"; then
  fail "a log is read as a model"
fi
grep -qF "small.csv: file: is not JSON" "$stage/log" || fail "no word of what is no model"

# As a part of the other's project
run consumer part -DKELPIE_SUBPROJECT="$source"

# pkg-config
export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name kelpie.pc)")
[ "$(pkg-config --modversion kelpie)" = "$version" ] || fail "the version in kelpie.pc"
if pkg-config --exists 'kelpie >= 99'; then fail "kelpie.pc claims to be version 99"; fi
# shellcheck disable=SC2046,SC2086  # flags are words
run "$cxx" -std=c++20 $flags "$source/examples/01_learner.cpp" -o "$stage/by_hand" \
  $(pkg-config --cflags --libs --static kelpie)
"$stage/by_hand" | cmp - "$stage/by_cmake" || fail "pkg-config's consumer says something else"

# The old name of a header that moved tells the new name, also where warnings are errors.
# shellcheck disable=SC2046,SC2086
run "$cxx" -std=c++20 $flags -Wall -Wextra -Werror -fsyntax-only -x c++ \
  -include kelpie/learner/online_svr.hpp -include kelpie/motion/diagnosis.hpp \
  $(pkg-config --cflags kelpie) "$source/tests/install/consumer/model_json.cpp"

# With flags of their own, and with Eigen: nothing in a header may follow from them.
others=("$cxx -O1 -march=native" "$cxx -O0 -DEIGEN_MAX_ALIGN_BYTES=0"
  "$cxx -O1 -std=c++23 -D_GLIBCXX_ASSERTIONS")
clang=$(compgen -c clang++ | grep -m 1 -E '^clang[+][+](-[0-9]+)?$' || true)
if [ -n "$clang" ] && [ -z "$flags" ]; then others+=("$clang -O1 -march=native"); fi
examples=(04_dead_reckoning)
if [ -n "$all" ]; then examples+=(03_controller); fi  # a controller's clock is real
for other in "${others[@]}"; do
  for example in "${examples[@]}"; do
    # shellcheck disable=SC2046,SC2086  # flags are words
    run ${other/ / -std=c++20 } $flags "$source/examples/$example.cpp" -o "$stage/by_other" \
      $(pkg-config --cflags --libs --static kelpie eigen3)
    run "$source/examples/check_output.sh" "$source/examples/$example.cpp" "$stage/by_other"
  done
  examples=(04_dead_reckoning)
done

# C
if command -v cc >/dev/null; then
  # shellcheck disable=SC2046,SC2086
  run cc -std=c99 -pedantic -Wall -Wextra -Werror $flags "$source/examples/07_in_c.c" \
    -o "$stage/in_c" $(pkg-config --cflags --libs --static kelpie)
  run "$source/examples/check_output.sh" "$source/examples/07_in_c.c" "$stage/in_c"
  # shellcheck disable=SC2046,SC2086
  run cc -std=c99 -pedantic -Wall -Wextra -Werror $flags "$source/tests/install/consumer/model_json.c" \
    -o "$stage/model_in_c" $(pkg-config --cflags --libs --static kelpie)
  "$stage/model_in_c" "$stage/learned/model.json" "${place[@]}" | cmp - "$stage/model_by_cmake" ||
    fail "a model.json says something else in C"
fi

# Presets of users need nothing of developers.
for preset in user minimal library; do
  run cmake -S "$source" --preset "$preset" -B "$stage/$preset"
  grep -qx 'KELPIE_BUILD_TESTS:BOOL=OFF' "$stage/$preset/CMakeCache.txt" || fail "$preset builds tests"
  ! grep -qE '^KELPIE_BUILD_(LAB|PYTHON|EXAMPLES):BOOL=ON' "$stage/$preset/CMakeCache.txt" ||
    fail "$preset builds what is for developers"
done
ninja -C "$stage/library" -t targets all >"$stage/log"
! grep -qE '^(kelpie_cli|kelpie_logs):' "$stage/log" || fail "the preset library builds more"

# The bill of materials
bill=$prefix/share/kelpie/kelpie.spdx.json
if [ -e "$bill" ]; then
  run /usr/bin/python3 -B "$source/tests/install/bill_test.py" "$bill" "$version" \
    libeigen3-dev libhwy1 nlohmann-json3-dev libsqlite3-0 libstdc++6
fi

# Debian packages, made of this build by the rules of the source package
if command -v dpkg-buildpackage >/dev/null && command -v dh_python3 >/dev/null; then
  mkdir -p "$stage/deb/kelpie"
  cp -r "$source"/{debian,docs,examples,README.md,CHANGELOG.md} "$stage/deb/kelpie"
  (cd "$stage/deb/kelpie" && run env KELPIE_BUILD_DIR="$build" DPKG_DEB_COMPRESSOR_TYPE=none \
    dpkg-buildpackage -b -d -nc --no-sign)
  grep -q "^kelpie ($version) " "$source/debian/changelog" || fail "debian/changelog is of another version"
  for package in libkelpie-dev kelpie-tools kelpie-live; do
    deb=$(find "$stage/deb" -maxdepth 1 -name "${package}_*.deb")
    dpkg-deb -c "$deb" >"$stage/$package"
    [ "$package" = kelpie-live ] || dpkg-deb -f "$deb" Depends | grep -q libhwy || fail "$package doesn't depend on Highway"
  done
  deb=$(find "$stage/deb" -maxdepth 1 -name "kelpie-doc_*.deb")
  dpkg-deb -c "$deb" >"$stage/kelpie-doc"
  for file in docs/howto/first_hour.md examples/bluerov.toml CHANGELOG.md README.md; do
    grep -q "/kelpie-doc/$file\$" "$stage/kelpie-doc" || fail "kelpie-doc is without $file"
  done
  deb=$(find "$stage/deb" -maxdepth 1 -name "python3-kelpie_*.deb")
  if [ -n "$deb" ]; then
    dpkg-deb -f "$deb" Depends | grep -q python3-numpy || fail "python3-kelpie doesn't depend on numpy"
    dpkg-deb -x "$deb" "$stage/python"
    [ -n "$flags" ] || [ "$(PYTHONPATH=$stage/python/usr/lib/python3/dist-packages /usr/bin/python3 -B -c \
      'import kelpie; print(kelpie.__version__)')" = "$version" ] || fail "python3-kelpie isn't imported"
  fi
  if [ -n "$all" ] && command -v lintian >/dev/null; then  # as scripts/packages.sh
    # Packing without compression is this test's, for time.
    run lintian --allow-root --fail-on error --suppress-tags \
      uses-no-compression-for-control-tarball,uses-no-compression-for-data-tarball "$stage"/deb/*.deb
  fi
  for file in libkelpie.a kelpieConfig.cmake kelpie.pc model/dynamics_model.hpp kelpie.h; do
    grep -q "/$file\$" "$stage/libkelpie-dev" || fail "libkelpie-dev is without $file"
  done
  for file in bin/kelpie "${manual[@]}" completions/kelpie vendor-completions/_kelpie; do
    grep -q "/$file\$" "$stage/kelpie-tools" || fail "kelpie-tools is without $file"
  done
  grep -q "/systemd/system/kelpie-live@.service\$" "$stage/kelpie-live" ||
    fail "kelpie-live is without its service"
  # Private headers are not for users: 40 at most are, and nine old names.
  [ "$(grep -cE '/include/kelpie/.*[.]hp?p?$' "$stage/libkelpie-dev")" -le 49 ] ||
    fail "libkelpie-dev has more than 40 headers and nine old names"
fi
echo "installed, found and used"
