#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Sets up the machine, builds kelpie and does its main job: learn a log as the vehicle drove, and
# measure the paper's claims again (the quick version; `kelpie-lab reproduce` is the whole).
# The log is that of AUV Dagon, looked for in $KELPIE_DATA_DIR, then in ../shared/data; where it is
# in neither, a small log of the simulated Dagon takes its place.
set -euo pipefail
cd "$(dirname "$0")"

log_name=dagon_config1.csv
log_url=https://github.com/MichalTesnar/mystery
log_sha256=e613d84e8e5db3c0213faeb1ee7cda6a944dcdbbe63e554560acbffd840e43b3

# A folder that ./test.sh has built already keeps `kelpie live` and all else.
preset=main
if grep -qs '^KELPIE_BUILD_LIVE:BOOL=ON' build/release/CMakeCache.txt; then preset=release; fi
scripts/build.sh $preset kelpie_cli kelpie_lab
kelpie=build/release/kelpie

log=
for folder in "${KELPIE_DATA_DIR:-}" ../shared/data; do
  if [ -n "$folder" ] && [ -f "$folder/$log_name" ]; then
    log=$folder/$log_name
    break
  fi
done

if [ -n "$log" ]; then
  if ! echo "$log_sha256  $log" | sha256sum --check --status; then
    echo "Note: $log is not the published file (its sha256 differs)."
  fi
  columns=(--rate 4)
else
  cat <<NOTE
The log of AUV Dagon is not here. It is public: get dagon_dataset.csv from
  $log_url
  (sha256 $log_sha256)
and put it as $log_name into a folder named by \$KELPIE_DATA_DIR or into ../shared/data.
Carrying on with a small log of the simulated Dagon.
NOTE
  log=out/simulated_dagon.csv
  mkdir -p out
  [ -f "$log" ] || "$kelpie" simulate scenarios/small.toml --out "$log"
  columns=()
fi

for split in random blocks; do
  echo
  "$kelpie" learn "$log" "${columns[@]}" --split "$split" --out "out/$split"
done
echo
build/release/kelpie-lab reproduce --quick --out out/reproduce
echo
echo "Report: $PWD/out/blocks/report.html"
echo "Paper:  $PWD/out/reproduce/reproduction.html"
