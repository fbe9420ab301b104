#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# 05: from a ROS 2 bag to a model, on the command line. Takes your bag and a file that names its
# topics (like 05_toy.toml), or records the toy vehicle. Writes everything into ./out.
# Usage: 05_bag_to_model.sh [BAG CONFIG]      (kelpie and 05_record_bag have to be in $PATH)
#
# Prints, among other things, for the toy vehicle:
#   out/toy.mcap: 4800 messages, 2 topics
#   1200 rows, 1196 whole in 1 stretch
#   udot: R² 0.999 over 239 rows held out when it learned
#   rdot: R² 0.996 over 239 rows held out when it learned
#   C: out/model.c (4 inputs, 2 predictions, double)
set -euo pipefail

bag=${1:-out/toy.mcap}
config=${2:-$(dirname "$0")/05_toy.toml}
if [ $# -eq 0 ]; then
  mkdir -p out
  05_record_bag "$bag"
fi

kelpie inspect "$bag"                                             # what is in it
kelpie learn "$bag" --config "$config" --split tail --out out     # learn all but the last fifth
kelpie predict --model out/model.json --config "$config" "$bag" --out out/predictions.csv
kelpie rollout "$bag" --model out/model.json --config "$config" --split tail --out out/rollout
kelpie export out/model.json --c out/model.c                      # for the autopilot
