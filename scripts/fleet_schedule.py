#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Simulates how long the runs of a study take on many ranks or in many parts (docs/fleet.md).

    python3 scripts/fleet_schedule.py JOURNAL [--jobs N] [--workers 1,64,1024] [--take-ms 1]

JOURNAL is the journal.jsonl of a study; its runs' measured seconds are the job times, its rows the
estimated costs. --jobs draws as many jobs with replacement. Two schedules of one worker per rank or
part: `counter`, each rank takes its next job from the shared counter, the costly first, in
`--take-ms`; `parts`, jobs are dealt by cost before (longest processing time first). Efficiency is the
jobs' seconds over the makespan of all workers.
"""

import argparse
import heapq
import json
import random
from pathlib import Path


def read_jobs(journal):
    """(estimated cost, seconds) of every run that has an outcome."""
    results = [json.loads(line)["result"] for line in journal.read_text().splitlines()[1:]]
    return [(one["training_rows"] + one["held_out_rows"], one["seconds"])
            for one in results if "error" not in one]


def counter(jobs, workers, take_s):
    ends = [0.0] * workers
    for _, seconds in jobs:
        heapq.heapreplace(ends, ends[0] + take_s + seconds)
    return max(ends)


def parts(jobs, workers):
    loads = [(0.0, part, 0.0) for part in range(workers)]  # estimated, part, seconds
    for cost, seconds in jobs:
        estimated, part, sum_s = loads[0]
        heapq.heapreplace(loads, (estimated + cost, part, sum_s + seconds))
    return max(load[2] for load in loads)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("journal", type=Path)
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--workers", default="1,64,1024")
    parser.add_argument("--take-ms", type=float, default=1.0)
    options = parser.parse_args()
    jobs = read_jobs(options.journal)
    if options.jobs:
        jobs = random.Random(1).choices(jobs, k=options.jobs)
    jobs.sort(key=lambda job: -job[0])
    total_s = sum(seconds for _, seconds in jobs)
    print(f"{len(jobs)} jobs of {total_s:.0f} s together, the longest {max(jobs, key=lambda j: j[1])[1]:.2f} s")
    print(f"{'workers':>8} {'counter':>10} {'efficiency':>10} {'parts':>10} {'efficiency':>10}")
    for workers in map(int, options.workers.split(",")):
        spans = counter(jobs, workers, 1e-3 * options.take_ms), parts(jobs, workers)
        print(f"{workers:8}" + "".join(f" {span:8.1f} s {total_s / (span * workers):10.3f}"
                                       for span in spans))


if __name__ == "__main__":
    main()
