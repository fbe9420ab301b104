#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Studies under mpirun whose processes are killed at random moments (docs/fleet.md).

    python3 scripts/fleet_kills.py KELPIE [STUDIES [SEED]]

KELPIE is the program, with libkelpie_mpi.so beside it or installed; STUDIES (100), each by two or
three ranks. At a random moment of each a rank gets SIGKILL, whichever, several times in a study;
then the same command is given again until it ends by itself. After every kill the journal has to be
readable, with all results that it had before and no run twice; in the end the result has to be that
of a study that nobody disturbed, but for its times. Exit code 1 where something isn't so.
"""

import json
import math
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

KILLS = 3  # in a study, at most
TIMES = {"seconds", "update_us", "update_us_p99", "real_time_share"}
STUDY = """
logs = "dives/{vehicle}/{mission}.csv"
splits = "pieces"
"""
LEARNER = """
[[learner]]
name = "{buffer}"
preset = "small"
set = {{warmup = 20, buffer = {buffer}}}
"""
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def write_study(folder):
    for vehicle in range(2):
        for dive in range(3):
            noise = random.Random(f"{vehicle} {dive}")
            u, phase, rows = 0.0, 0.0, ["t,u,n,udot"]
            for row in range(2000):
                phase += noise.uniform(0.01, 0.05)
                n = 10 * math.sin(phase)
                udot = 0.01 * n * abs(n) - 2 * u * abs(u) - 0.3 * u
                rows.append(f"{0.1 * row:.1f},{u:.9f},{n:.9f},{udot:.9f}")
                u += 0.1 * udot
            file = folder / f"dives/auv{vehicle}/dive{dive}.csv"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text("\n".join(rows) + "\n")
    buffers = (30, 40, 50, 60)
    (folder / "fleet.toml").write_text(STUDY + "".join(LEARNER.format(buffer=b) for b in buffers))


def without_times(node):
    if isinstance(node, dict):
        return {key: without_times(value) for key, value in node.items() if key not in TIMES}
    return [without_times(item) for item in node] if isinstance(node, list) else node


def journal_lines(file):
    """Line by key. A last line that was cut off is none; any other that is wrong is an error."""
    lines = {}
    if not file.exists():
        return lines
    whole = file.read_bytes().split(b"\n")[:-1]
    for number, line in enumerate(whole, 1):
        match = re.fullmatch(rb'\{"crc32":"([0-9a-f]{8})",(.*)', line)
        assert match and int(match[1], 16) == zlib.crc32(match[2]), f"{file}:{number}: broken"
        if number > 1:
            key = json.loads(line)["key"]
            assert key not in lines, f"{file}:{number}: {key} is there twice"
            lines[key] = line
    return lines


def ranks_of(mpirun):
    children = Path(f"/proc/{mpirun}/task/{mpirun}/children")
    try:
        return [int(pid) for pid in children.read_text().split()]
    except FileNotFoundError:
        return []


def attack(command, folder, dice, seconds):
    """Runs the command, and kills one of its ranks unless it has ended before. Its exit code."""
    with open(folder / "said", "w", encoding="utf-8") as said:
        process = subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, stdout=said, stderr=said)
        if seconds is not None:
            end = time.monotonic() + seconds
            while time.monotonic() < end and process.poll() is None:
                time.sleep(0.01)
            if ranks := ranks_of(process.pid):
                try:
                    os.kill(dice.choice(ranks), signal.SIGKILL)
                except ProcessLookupError:
                    pass
        return process.wait(timeout=600)


def main():
    if len(sys.argv) < 2:
        return __doc__
    kelpie, *given = sys.argv[1:]
    studies, seed = map(int, given + ["100", "1"][len(given):])
    dice = random.Random(seed)
    folder = Path(tempfile.mkdtemp())
    write_study(folder)

    def command(ranks, out):
        start = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        return [*start, str(Path(kelpie).resolve()), "study", "fleet.toml", "--out", out]

    def result(out):
        return without_times(json.loads((folder / out / "study.json").read_text()))

    begin = time.monotonic()
    assert attack(command(2, "undisturbed"), folder, dice, None) == 0, (folder / "said").read_text()
    usual_s = time.monotonic() - begin
    wanted = result("undisturbed")
    runs = len(journal_lines(folder / "undisturbed/journal.jsonl"))
    starts = kills = kept = 0
    for study in range(studies):
        out = f"study{study}"
        before, left = {}, dice.randint(1, KILLS)
        while True:
            seconds = dice.uniform(0.2, 0.9) * usual_s if left > 0 else None
            code = attack(command(dice.choice([2, 3]), out), folder, dice, seconds)
            starts += 1
            after = journal_lines(folder / out / "journal.jsonl")
            lost = [key for key, line in before.items() if after.get(key) != line]
            assert not lost, f"{out}: lost or changed: {lost}"
            if code == 0:
                break
            assert seconds is not None, (folder / "said").read_text()
            kills += 1
            left -= 1
            kept += len(after) - len(before)
            before = after
        assert len(after) == runs, f"{out}: {len(after)} runs, not {runs}"
        assert result(out) == wanted, f"{out}: another result than the undisturbed study's"
        shutil.rmtree(folder / out)
    shutil.rmtree(folder)
    print(f"{studies} studies of {runs} runs, {starts} starts, {kills} kills, {kept} results kept "
          "over them: none lost, none twice, every journal readable, every result as undisturbed")
    return None


if __name__ == "__main__":
    sys.exit(main())
