#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a clean Debian 12 to a learned log in two commands, by the Debian package, the wheel, the image.
# Prints times and sizes (docs/howto/install.md#from-nothing-to-a-learned-log).
# Usage, as root: scripts/doors.sh FOLDER [WHEEL [IMAGE]]
# FOLDER has the packages of scripts/packages.sh. Debian packages: mmdebstrap, umoci, curl.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ $# -lt 1 ] || [ "$(id -u)" -ne 0 ]; then
  echo "usage, as root: scripts/doors.sh FOLDER [WHEEL [IMAGE]]" >&2
  exit 2
fi
deb=$(find "$1" -name "kelpie-tools_*_$(dpkg --print-architecture).deb") wheel=${2:-} image=${3:-}
[ -f "$deb" ] || { echo "$1: needs one kelpie-tools_*.deb" >&2; exit 2; }
stage=$(mktemp -d)
finish() {
  umount "$stage"/*/proc 2>/dev/null || true
  rm -rf --one-file-system "$stage"
}
trap finish EXIT

# clean_root NAME: a root with what every Debian has
clean_root() {
  mmdebstrap --quiet --variant=minbase bookworm "$stage/$1" 2>"$stage/log" ||
    { cat "$stage/log" >&2; exit 1; }
  mount -t proc proc "$stage/$1/proc"
}
# timed ROOT COMMAND: seconds that a command takes there; what the command says goes into the log
timed() {
  local from=$EPOCHREALTIME
  chroot "$stage/$1" sh -c "$2" >"$stage/log" 2>&1 || { cat "$stage/log" >&2; exit 1; }
  awk -v a="$from" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.0f s", b - a }'
}
megabytes() { du -sm --apparent-size -x "$1" --exclude proc | cut -f1; }
# row DOOR FILE ROOT FIRST SECOND: runs both commands, prints a row
row() {
  local before first second
  before=$(megabytes "$stage/$3")
  first=$(timed "$3" "$4")
  second=$(timed "$3" "$5")
  [ -s "$stage/$3/out/model.json" ] || { echo "$1: nothing was learned" >&2; exit 1; }
  echo "| $1 | $(awk -v b="$(stat -c %s "$2")" 'BEGIN { printf "%.1f", b / 1e6 }') MB |" \
    "+$(($(megabytes "$stage/$3") - before)) MB | $first | $second |"
}
apt='export DEBIAN_FRONTEND=noninteractive; apt-get update -qq &&
  apt-get install -y -qq --no-install-recommends'

echo "| door | file | installed | first command | second |"
echo "|---|---|---|---|---|"
clean_root deb
cp "$deb" "$stage/deb/"
row "Debian package" "$deb" deb "$apt /$(basename "$deb")" \
  "kelpie simulate /usr/share/kelpie/scenarios/small.toml --out /log.csv &&
   kelpie learn /log.csv --out /out"
if [ -n "$wheel" ]; then
  clean_root wheel
  cp "$wheel" "$stage/wheel/"
  cp "$stage/deb/log.csv" "$stage/wheel/"
  row wheel "$wheel" wheel \
    "$apt python3-pip python3-numpy &&
     pip install --quiet --break-system-packages --no-index /$(basename "$wheel")" \
    "python3 -c 'import kelpie; print(kelpie.report(\"/log.csv\", out=\"/out\"))'"
fi
if [ -n "$image" ]; then
  from=$EPOCHREALTIME
  umoci unpack --image "$image:latest" "$stage/bundle" >"$stage/log" 2>&1
  first=$(awk -v a="$from" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.0f s", b - a }')
  mv "$stage/bundle/rootfs" "$stage/image"
  cp "$stage/deb/log.csv" "$stage/image/"
  second=$(timed image "kelpie learn /log.csv --out /out")
  [ -s "$stage/image/out/model.json" ] || { echo "image: nothing was learned" >&2; exit 1; }
  echo "| image | $(megabytes "$image") MB | +$(megabytes "$stage/image") MB | $first | $second |"
  # The page of `kelpie live` answers, and rows are learned.
  chroot "$stage/image" sh -c 'cd /tmp && exec kelpie live --demo --page 127.0.0.1:9850' \
    >"$stage/log" 2>&1 &
  live=$!
  sleep 10
  rows=$(curl -sf http://127.0.0.1:9850/metrics |
    sed -n 's/^kelpie_rows_total \([0-9]*\).*/\1/p') || true
  kill -INT "$live"
  wait "$live" || true
  [ "${rows:-0}" -gt 0 ] || { cat "$stage/log" >&2; echo "image: the page is silent" >&2; exit 1; }
  echo "The page of kelpie live, run in the image, tells of $rows rows."
fi
