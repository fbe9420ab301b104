#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian 12 packages that are missing for a preset, and puts uPlot, which draws the
# figures of kelpie's pages and which Debian 12 has no package of, into build/uplot. Quick and silent
# when nothing is missing.
# Usage: scripts/setup.sh [PRESET]   (library, minimal, main, user; any other: all of a developer)
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release}
packages=( g++ cmake ninja-build pkg-config libeigen3-dev libhwy-dev nlohmann-json3-dev )
wants() { [[ " $* " == *" $preset "* ]]; }
everything() { ! wants library minimal main user; }
if ! wants library; then
  packages+=(
    libfmt-dev libcli11-dev libtomlplusplus-dev libsqlite3-dev libzstd-dev liblz4-dev libbz2-dev
    libyaml-cpp-dev zlib1g-dev libzip-dev libtinyxml2-dev
  )
fi
if wants main user || everything; then packages+=( libmatio-dev ); fi
if wants main || everything; then packages+=( libsvm-dev ); fi
if wants minimal user || everything; then packages+=( help2man ); fi
if wants user || everything; then
  packages+=( libsystemd-dev cyclonedds-dev libmicrohttpd-dev libssl-dev )
fi
if everything; then
  packages+=(
    libgtest-dev librapidcheck-dev libfastrtps-dev libfastcdr-dev doxygen
    pybind11-dev python3-dev python3-numpy python3-setuptools python3-pip python3-build
    python3-pytest python3-sklearn python3-pandas python3-matplotlib python3-distributed
    chromium chromium-driver python3-selenium
    debhelper dh-python patchelf libxml2-utils lua5.3
  )
fi
uplot="uplot-1.6.32"
uplot_sha256=4b8a8191e425658e3ea8c8c1314b0fc679c861ee3a1af2b20c7b16ba50b5133d

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done

install_packages() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "kelpie needs these Debian packages: $*" >&2
      echo "Install them as root: apt-get install $*" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing $*" >&3
  "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install --yes --no-install-recommends "$@"
}

fetch_uplot() {
  command -v npm >/dev/null || install_packages npm || return
  rm -rf build/uplot
  mkdir -p build/uplot
  (cd build/uplot &&
    npm pack --silent "${uplot/-/@}" &&
    echo "$uplot_sha256  $uplot.tgz" | sha256sum --check --quiet &&
    tar -xzf "$uplot.tgz" && touch "$uplot")
}

log=$(mktemp)
trap 'rm -f "$log"' EXIT
exec 3>&1  # past the log
quietly() { "$@" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }; }
[ ${#missing[@]} -eq 0 ] || quietly install_packages "${missing[@]}"
wants library || [ -e "build/uplot/$uplot" ] || fetch_uplot >"$log" 2>&1 || {
  cat "$log" >&2
  echo "uPlot couldn't be fetched: kelpie's pages will have tables and no figures" >&2
}
