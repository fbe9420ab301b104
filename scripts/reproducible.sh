#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the last commit's Debian packages and the wheel twice (scripts/packages.sh): in folders of
# other names and lengths, at other times, in another time zone. Tells which files have the same
# bytes; exit code 1 where one differs (`diffoscope A B` shows how).
# Usage: scripts/reproducible.sh [FOLDER]   (default: build/reproducible; FOLDER/a/ of an earlier run
# is the first build)
set -euo pipefail
cd "$(dirname "$0")/.."

out=${1:-build/reproducible}
mkdir -p "$out"
out=$(realpath "$out")
here=$(dpkg --print-architecture)
[ -d "$out/a" ] || scripts/packages.sh "$here" "$out/a"
KELPIE_PLACE=/srv/another/place TZ=Pacific/Chatham scripts/packages.sh "$here" "$out/b"

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
