#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs `kelpie study` in parts on the machines of a Dask cluster, and merges the parts.

    /usr/bin/python3 examples/14_study_in_parts.py fleet.toml --scheduler tcp://HEAD:8786

Without --scheduler two processes of this machine work. Every machine needs the same version of
kelpie, and a file system with the same paths. The parts keep journals, so the same command goes on
where a cluster was lost. Needs Debian's python3-distributed.
"""

from __future__ import annotations

import argparse
import subprocess
from pathlib import Path

from distributed import Client, LocalCluster, as_completed


def run_part(command: list[str], part: str) -> tuple[str, int, str]:
    """A part of the study, on a worker; gives the exit code and the last line on errors."""
    done = subprocess.run([*command, "--threads", "1", "--part", part], capture_output=True,
                          text=True, check=False)
    return part, done.returncode, (done.stderr.strip().splitlines() or [""])[-1]


def run_study(client: Client, command: list[str], parts: int) -> int:
    """All parts, one per free thread of a worker, then the merge. Returns the exit code."""
    jobs = [client.submit(run_part, command, f"{k}/{parts}", pure=False, retries=2)
            for k in range(1, parts + 1)]
    for _, (part, code, why) in as_completed(jobs, with_results=True):
        print(f"part {part}: {'done' if code == 0 else why}", flush=True)
    return subprocess.run([*command, "--merge"], check=False).returncode


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("study", type=Path, help="TOML file of the study")
    parser.add_argument("--out", type=Path, default=Path("out/study"))
    parser.add_argument("--kelpie", default="kelpie", help="the program, on every machine")
    parser.add_argument("--parts", type=int, default=16)
    parser.add_argument("--scheduler", help="address of a Dask scheduler")
    options = parser.parse_args()
    command = [options.kelpie, "study", str(options.study.resolve()), "--out",
               str(options.out.resolve())]
    if options.scheduler:
        with Client(options.scheduler) as client:
            return run_study(client, command, options.parts)
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, \
            Client(cluster) as client:
        return run_study(client, command, options.parts)


if __name__ == "__main__":  # Dask's workers read this file, too
    raise SystemExit(main())
