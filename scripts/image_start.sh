#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# What the image of scripts/image.sh runs: `kelpie live` with /data/vehicle.toml, which is
# examples/bluerov.toml until a user changes the file. The page wants the token that the log names.
set -eu
[ -f /data/vehicle.toml ] || cp /usr/share/kelpie/bluerov.toml /data/vehicle.toml
exec kelpie live --config /data/vehicle.toml --out /data/live --record /data/rec \
  --page "${KELPIE_PAGE:-0.0.0.0:9850}" "$@"
