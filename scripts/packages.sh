#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the Debian source package of the last commit, its packages and the portable wheel, in a clean
# root of Debian 12: lintian reads the packages, and debian/tests run with the packages installed in
# another root. For arm64 Debian's cross compiler builds (no Python, no manual page).
# Usage: scripts/packages.sh [amd64|arm64] [FOLDER]   (default: this machine's, build/packages)
# Debian packages: mmdebstrap, dpkg-dev. KELPIE_PLACE: the folder in the root where packages are
# built (/build); KELPIE_RUN: a command that runs the build, such as `nice -n 10`.
set -euo pipefail
cd "$(dirname "$0")/.."

here=$(dpkg --print-architecture)
architecture=${1:-$here} out=${2:-build/packages} place=${KELPIE_PLACE:-/build}
{ command -v mmdebstrap && command -v dpkg-source; } >/dev/null ||
  { echo "Install these first: apt-get install mmdebstrap dpkg-dev" >&2; exit 1; }
[ -e build/uplot/package ] ||
  { echo "scripts/setup.sh fetches uPlot, which the pages need" >&2; exit 1; }
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
mkdir -p "$out" build
out=$(realpath "$out")

# The source package: the last commit, and uPlot where CMake looks for it
version=$(sed -nE '1s/.*\((.*)\).*/\1/p' debian/changelog)
source=$stage/kelpie-$version
git archive --prefix="kelpie-$version/" HEAD | tar -x -C "$stage"
mkdir -p "$source/build/uplot"
cp -r build/uplot/package "$source/build/uplot/"
chmod -R u=rwX,go=rX "$source"
(cd "$stage" && dpkg-source --build "kelpie-$version" >/dev/null)

build=(dpkg-buildpackage --no-sign -b)
# The wheel: the same objects, but those that read files of MATLAB (setup.py tells why)
wheel='export SOURCE_DATE_EPOCH=$(dpkg-parsechangelog -STimestamp) &&
  cmake -DKELPIE_WITH_MATLAB=OFF build/debian &&
  ninja -C build/debian ${DEB_BUILD_OPTIONS:+-j1} kelpie_python &&
  KELPIE_PORTABLE=1 KELPIE_BUILD_DIR=build/debian python3 -m pip wheel --no-build-isolation \
    --no-index --no-deps --wheel-dir .. .'
wanted=(lintian python3-pip patchelf)
architectures=$here
lint=(lintian --allow-root --fail-on 'error,warning')
if [ "$architecture" != "$here" ]; then
  build=(dpkg-buildpackage --no-sign -B "-a$architecture" -Pcross,nocheck)
  wanted=(lintian "crossbuild-essential-$architecture")
  wheel=:
  architectures+=,$architecture
  lint+=(--suppress-tags no-manual-page)  # help2man can't run the command
fi
dependencies=(apt-get build-dep --yes -qq --no-install-recommends)
[ "$architecture" = "$here" ] || dependencies+=("-a$architecture" -Pcross,nocheck)

echo "Building kelpie $version ($architecture) in a clean root"
# shellcheck disable=SC2016  # $1 is mmdebstrap's root
mmdebstrap --quiet --variant=buildd --format=null --dpkgopt=force-unsafe-io \
  --architectures="$architectures" --include="$(IFS=,; echo "${wanted[*]}")" \
  --customize-hook="mkdir -p \"\$1$place\"" \
  --customize-hook="copy-in $source $stage/kelpie_$version.dsc $stage/kelpie_$version.tar.xz $place" \
  --customize-hook="chroot \"\$1\" sh -c 'cd $place/kelpie-$version &&
    DEBIAN_FRONTEND=noninteractive ${dependencies[*]} ./'" \
  --customize-hook="${KELPIE_RUN:-} chroot \"\$1\" sh -c 'cd $place/kelpie-$version &&
    ${build[*]} && $wheel'" \
  --customize-hook="chroot \"\$1\" sh -c 'cd $place &&
    ${lint[*]} *.changes *.dsc'" \
  --customize-hook="rm -rf \"\$1$place/kelpie-$version\"" \
  --customize-hook="sync-out $place $out" \
  bookworm /dev/null >"build/packages-$architecture.log" 2>&1 || {
  tail -40 "build/packages-$architecture.log" >&2
  exit 1
}

if [ "$architecture" = "$here" ]; then
  echo "Installing its packages in another one, and running their tests"
  # shellcheck disable=SC2016
  packages=("$out"/{kelpie-{tools,live,doc},libkelpie-dev,python3-kelpie}_"$version"_*.deb)
  mmdebstrap --quiet --variant=apt --format=null --dpkgopt=force-unsafe-io \
    --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
    --include="g++,pkg-config,$(IFS=,; echo "${packages[*]}")" \
    --customize-hook="copy-in debian/tests /tmp" \
    --customize-hook='for test in learn python build; do
      chroot "$1" "/tmp/tests/$test" || { echo "debian/tests/$test failed" >&2; exit 1; }; done' \
    bookworm /dev/null >"build/packages-tests.log" 2>&1 ||
    { tail -40 build/packages-tests.log >&2; exit 1; }
fi
ls -s --block-size=1k "$out" | sed -n "s/^ *\([0-9]*\) \(.*$version.*\\.\(deb\|whl\)\)/\1 kB \2/p"
