#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds kelpie for 64-bit ARM on another machine and runs its tests under qemu. Debian's cross
# compiler and qemu have to be there (it says so otherwise); libraries of arm64 are unpacked into
# build/arm64-root, without root's rights and without touching the machine.
# Usage: scripts/arm64.sh [TARGET...]   (default: everything; library, logs, tools, live and lab run
# the tests of these buildings, test_NAME those of a program)
set -euo pipefail
cd "$(dirname "$0")/.."

# Of all these apt finds what they need in turn (Cyclone DDS and libmatio need much).
libraries=(
  libeigen3-dev libhwy-dev libfmt-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev
  libsqlite3-dev libzstd-dev liblz4-dev libbz2-dev libyaml-cpp-dev zlib1g-dev libsvm-dev libgtest-dev
  librapidcheck-dev cyclonedds-dev libmicrohttpd-dev libssl-dev libmatio-dev libsystemd-dev
  libzip-dev libtinyxml2-dev
)
# The cross compiler has its own of these.
toolchain='^(libc6|libc6-dev|libc-dev-bin|linux-libc-dev|libgcc-s1|libstdc\+\+6|gcc-12-base)_'

missing=()
for package in g++-aarch64-linux-gnu qemu-user cmake ninja-build pkg-config; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "Install these first: apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 1
fi

root=$PWD/build/arm64-root
fill_root() {
  local apt=$root/apt
  local options=(-o "Dir::State=$apt" -o "Dir::State::status=$apt/status" -o "Dir::Cache=$apt"
    -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Acquire::Languages=none
    -o APT::Sandbox::User= --yes --no-install-recommends)
  mkdir -p "$apt/lists/partial" "$apt/archives/partial"
  : >"$apt/status"  # of a machine that has nothing
  apt-get "${options[@]}" update
  apt-get "${options[@]}" install --download-only "${libraries[@]}"
  for package in "$apt"/archives/*.deb; do
    basename "$package" | grep -qE "$toolchain" || dpkg-deb -x "$package" "$root"
  done
  # Links of development packages to /lib have to stay inside.
  find "$root/usr/lib" -type l -lname '/*' | while read -r link; do
    ln -sfnr "$root$(readlink "$link")" "$link"
  done
  echo "${libraries[*]}" >"$root/filled"
}

log=build/arm64.log
mkdir -p build
quietly() { "$@" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }; }
if [ "$(cat "$root/filled" 2>/dev/null)" != "${libraries[*]}" ]; then
  echo "Unpacking libraries of arm64 into build/arm64-root"
  quietly fill_root
fi
echo "Building kelpie (arm64)"
[ $# -gt 0 ] || set -- all
quietly cmake --preset arm64
quietly cmake --build --preset arm64 --target "$@"
# run_tests OPTION...: programs that weren't built have no tests but a place holder.
run_tests() {
  ctest --preset arm64 --parallel "$(nproc)" --exclude-regex '_NOT_BUILT$' \
    --label-exclude '^(measured|nightly)$' "$@"
}
echo "Running its tests under qemu"
buildings=$(printf '%s\n' "$@" | sed -nE '/^(library|logs|tools|live|lab)$/p' | paste -sd '|')
rooms=$(printf '%s\n' "$@" | sed -n 's/^test_//p' | paste -sd '|')
[ "$*" != all ] || run_tests
[ -z "$buildings" ] || run_tests --label-regex "^($buildings)\$"
[ -z "$rooms" ] || run_tests --tests-regex "^($rooms)\."
# The rooms core and svr have the vector instructions: once more with SVE
[ ! -x build/arm64/test_core ] ||
  qemu-aarch64 -cpu max -L /usr/aarch64-linux-gnu build/arm64/test_core --gtest_brief=1
