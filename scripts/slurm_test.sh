#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A study under a real Slurm of one machine, which is started here for it and ended again (Debian
# packages slurm-wlm, munge; as root), as a job array. The result has to be that of threads.
# Usage: scripts/slurm_test.sh [KELPIE [TASKS]]
set -euo pipefail
cd "$(dirname "$0")/.."

kelpie=$(realpath "${1:-build/release/kelpie}") tasks=${2:-3}
for program in munged slurmctld slurmd sbatch srun scontrol; do
  command -v "$program" >/dev/null || { echo "there is no $program (Debian: slurm-wlm, munge)"; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "slurmd wants to be root"; exit 77; }

folder=$(mktemp -d)
pids=()
end() {
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$folder"
}
trap end EXIT
fail() {
  echo "FAILED: $1" >&2
  tail -n 20 "$folder"/*.log "$folder"/study/*.log >&2 2>/dev/null || true
  exit 1
}

# until COMMAND...: waits for it to be true, half a minute.
until_true() {
  for _ in $(seq 150); do
    if "$@" >/dev/null 2>&1; then return; fi
    sleep 0.2
  done
  fail "waited for $*"
}

chmod 755 "$folder"
mkdir -m 700 "$folder/munge"
mkdir "$folder/state" "$folder/spool" "$folder/study"
dd if=/dev/urandom of="$folder/munge/key" bs=1 count=1024 status=none
chmod 400 "$folder/munge/key"
munged --foreground --force --key-file="$folder/munge/key" --socket="$folder/munge.socket" \
  --pid-file="$folder/munge/pid" --seed-file="$folder/munge/seed" --log-file="$folder/munge.log" \
  >"$folder/munged.log" 2>&1 &
pids+=($!)
until_true munge --socket="$folder/munge.socket" --no-input

port=$((20000 + RANDOM % 20000))
host=$(hostname -s)
cat >"$folder/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SlurmdParameters=config_overrides
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$tasks State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP
CONF
export SLURM_CONF=$folder/slurm.conf
slurmctld -D >"$folder/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D -N "$host" >"$folder/slurmd.log" 2>&1 &
pids+=($!)
idle() { [ "$(sinfo --noheader --format=%T)" = idle ]; }
until_true idle

cd "$folder/study"
for vehicle in auv1 auv2; do
  for dive in 1 2 3 4; do
    mkdir -p "dives/$vehicle"
    awk -v seed="$vehicle$dive" 'BEGIN {
      print "t,u,n,udot"
      for (k = 1; k <= length(seed); ++k) phase += 0.1 * index("auv123456789", substr(seed, k, 1))
      for (i = 0; i < 400; ++i) {
        n = 10 * sin(phase += 0.01 + 0.02 * ((i * 7919) % 13) / 13)
        udot = 0.01 * n * (n < 0 ? -n : n) - 2 * u * (u < 0 ? -u : u) - 0.3 * u
        printf "%.1f,%.9f,%.9f,%.9f\n", 0.1 * i, u, n, udot
        u += 0.1 * udot
      }
    }' >"dives/$vehicle/dive$dive.csv"
  done
done
cat >fleet.toml <<'TOML'
logs = "dives/{vehicle}/{mission}.csv"
splits = "pieces"

[[learner]]
name = "small"
preset = "small"
set = {warmup = 20, buffer = 30}

[[learner]]
name = "no terms"
preset = "small"
set = {warmup = 20, buffer = 30, terms = "none"}
TOML

# comparable FILE: a result without its times.
comparable() {
  python3 - "$1" <<'PYTHON'
import json, sys

TIMES = {"seconds", "update_us", "update_us_p99", "real_time_share"}

def without_times(node):
    if isinstance(node, dict):
        return {key: without_times(value) for key, value in node.items() if key not in TIMES}
    return [without_times(item) for item in node] if isinstance(node, list) else node

print(json.dumps(without_times(json.load(open(sys.argv[1]))), indent=1))
PYTHON
}

"$kelpie" study fleet.toml --out by_threads >/dev/null 2>&1 || fail "the study on threads"
comparable by_threads/study.json >b

KELPIE=$kelpie sbatch --wait --array=1-"$tasks" \
  "$OLDPWD/scripts/slurm/kelpie-study-array.sbatch" fleet.toml --out by_array >submitted 2>&1 ||
  fail "the job array: $(cat submitted)"
"$kelpie" study fleet.toml --out by_array --merge >/dev/null 2>&1 || fail "the merge"
comparable by_array/study.json >a
cmp a b || fail "the job array's result is another than that of threads"

# Several processes must not do one study each.
if srun --ntasks="$tasks" "$kelpie" study fleet.toml --out none >refused 2>&1; then
  fail "accepted several processes for one study"
fi
grep -q "has started $tasks processes, and each would do the whole work" refused || fail "$(cat refused)"
echo "a study of 16 runs in $tasks parts as a job array of Slurm $(sinfo --version | cut -d' ' -f2): as on threads"
