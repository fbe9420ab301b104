#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What systemd itself says of the service: nothing wrong with it, and how much it could do to the
# machine if it were taken over (0: nothing, 10: everything; what is below 2 counts as "OK").
# Usage: service_test.sh UNIT KELPIE; 77: there is no systemd-analyze to ask.
set -euo pipefail

unit=$1 kelpie=$2
command -v systemd-analyze >/dev/null || { echo "no systemd-analyze"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
file=$folder/kelpie-live@auv.service
# It looks for the command where it isn't installed yet.
sed "s|^ExecStart=kelpie |ExecStart=$kelpie |" "$unit" >"$file"
grep -q "^ExecStart=$kelpie live " "$file"

# Of other units on this machine it may say whatever it likes.
systemd-analyze verify --man=no "$file" >"$folder/said" 2>&1 || true
if grep -F kelpie-live "$folder/said"; then exit 1; fi

if systemd-analyze security --help 2>/dev/null | grep -q -- --offline; then
  systemd-analyze security --no-pager --offline=yes --threshold=20 "$file" >"$folder/said" 2>&1 ||
    { cat "$folder/said"; exit 1; }
  tail -n 1 "$folder/said"
fi
