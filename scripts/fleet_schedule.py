#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Simulates how long the runs of a study take in parts (docs/howto/studies.md).

    python3 scripts/fleet_schedule.py JOURNAL [--jobs N] [--workers 1,64,1024]
                                      [--buffers LEARNER=SAMPLES,...]

JOURNAL is the journal.jsonl of a study; its runs' measured seconds are the job times. The estimated
cost is the number of rows times 100 + the learner's buffer (900 where --buffers is silent); the
program has the log's bytes for rows. --jobs draws as many jobs with replacement. Jobs are
dealt as jobs::deal_by_cost does: bundles of each learner by longest processing time first, the
costliest bundle to the part with the least.
Efficiency is the jobs' seconds over the makespan of all workers.
"""

import argparse
import heapq
import json
import random
from pathlib import Path


def read_jobs(journal, buffers):
    """(estimated cost, seconds, learner) of every run that has an outcome."""
    jobs = []
    for line in journal.read_text().splitlines()[1:]:
        run = json.loads(line)
        result, learner = run["result"], run["key"].split(" | ")[-2]
        if "error" not in result:
            rows = result["training_rows"] + result["held_out_rows"]
            jobs.append((rows * (100 + buffers.get(learner, 900)), result["seconds"], learner))
    return jobs


def parts(jobs, workers):
    loads = [(0.0, 0.0)] * workers  # estimated, seconds
    for learner in dict.fromkeys(job[2] for job in jobs):  # that of the costliest job first
        bundles = [(0.0, bundle, 0.0) for bundle in range(workers)]
        for cost, seconds, other in jobs:
            if other == learner:
                estimated, bundle, sum_s = bundles[0]
                heapq.heapreplace(bundles, (estimated + cost, bundle, sum_s + seconds))
        loads = [(load[0] + bundle[0], load[1] + bundle[2])
                 for load, bundle in zip(sorted(loads), sorted(bundles, reverse=True))]
    return max(load[1] for load in loads)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("journal", type=Path)
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--workers", default="1,64,1024")
    parser.add_argument("--buffers", default="")
    options = parser.parse_args()
    buffers = {name: int(size) for name, size in
               (pair.split("=") for pair in options.buffers.split(",") if pair)}
    jobs = read_jobs(options.journal, buffers)
    if options.jobs:
        jobs = random.Random(1).choices(jobs, k=options.jobs)
    jobs.sort(key=lambda job: -job[0])
    total_s = sum(job[1] for job in jobs)
    print(f"{len(jobs)} jobs of {total_s:.0f} s together, the longest {max(jobs, key=lambda j: j[1])[1]:.2f} s")
    print(f"{'parts':>8} {'makespan':>10} {'efficiency':>10}")
    for workers in map(int, options.workers.split(",")):
        span = parts(jobs, workers)
        print(f"{workers:8} {span:8.1f} s {total_s / (span * workers):10.3f}")


if __name__ == "__main__":
    main()
