#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# What the image of scripts/image.sh runs: `kelpie live` with /data/vehicle.toml where a user has put
# one; else the vehicle at $KELPIE_MAVLINK tells what its messages mean. The page wants the token that
# the log names.
set -eu
if [ -f /data/vehicle.toml ]; then
  set -- --config /data/vehicle.toml "$@"
else
  set -- --mavlink "${KELPIE_MAVLINK:-udp:14550}" "$@"
fi
exec kelpie live --out /data/live --record /data/rec --page "${KELPIE_PAGE:-0.0.0.0:9850}" "$@"
