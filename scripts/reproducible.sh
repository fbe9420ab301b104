#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the last commit's Debian packages, or the portable wheel, twice: in folders of other names
# and lengths, at other times, in another time zone and locale, with another umask. Tells which files
# have the same bytes; exit code 1 where one differs (`diffoscope A B` shows how).
# Usage: scripts/reproducible.sh packages|wheel [FOLDER]   (default: build/reproducible)
# `packages` takes a FOLDER/a/ of an earlier run for the first build. The wheel is built by this
# machine's tools, from a clean copy of the commit; needs what setup.sh installs.
set -euo pipefail
cd "$(dirname "$0")/.."

what=${1:-} out=${2:-build/reproducible}
mkdir -p "$out"
out=$(realpath "$out")
# The time of the last commit, as Debian's tools take it from debian/changelog
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)

# wheel NAME FOLDER: a wheel built in FOLDER
wheel() {
  mkdir -p "$2/build/uplot"
  git archive HEAD | tar -x -C "$2"
  cp -r build/uplot/package "$2/build/uplot/"
  (cd "$2" && KELPIE_PORTABLE=1 /usr/bin/python3 -m pip wheel --quiet --no-build-isolation --no-index \
    --no-deps --wheel-dir "$out/$1" .)
}

case $what in
  packages)
    [ -d "$out/a" ] || scripts/debian.sh "$(dpkg --print-architecture)" "$out/a"
    KELPIE_PLACE=/srv/another/place TZ=Pacific/Chatham LC_ALL=C.UTF-8 \
      scripts/debian.sh "$(dpkg --print-architecture)" "$out/b"
    ;;
  wheel)
    export SOURCE_DATE_EPOCH
    stage=$(mktemp -d)
    trap 'rm -rf "$stage"' EXIT
    wheel a "$stage/one"
    (umask 077 && TZ=Pacific/Chatham LC_ALL=C.UTF-8 wheel b "$stage/another/place")
    ;;
  *)
    echo "usage: scripts/reproducible.sh packages|wheel [FOLDER]" >&2
    exit 2
    ;;
esac

differ=0 count=0
for file in "$out"/a/*.{deb,dsc,tar.xz,whl}; do
  [ -e "$file" ] || continue
  count=$((count + 1))
  if cmp -s "$file" "$out/b/$(basename "$file")"; then
    echo "same    $(sha256sum "$file" | cut -c1-16)  $(basename "$file")"
  else
    echo "DIFFERS                   $(basename "$file")"
    differ=1
  fi
done
[ "$count" -gt 0 ] || { echo "nothing was built" >&2; exit 1; }
exit "$differ"
