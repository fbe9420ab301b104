#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Studies and learning runs that are killed at random moments (docs/howto/studies.md).

    python3 scripts/fleet_kills.py KELPIE [STUDIES [SEED]]

KELPIE is the program. STUDIES (100) run as two or three parts at a time. At a random moment a part
gets SIGKILL, several times in a study; then the same command is given again until it ends by itself,
and the parts are merged. After every kill all journals have to be readable, with all results that were
there before, and no run twice in a journal; the result has to be that of one process, but for its
times. Before, `kelpie learn` with a checkpoint every 20 samples is killed STUDIES times and goes on
from its checkpoint (docs/reference/files.md): the newest or the one before has to be whole
after every kill, no result half written, and model and result have to be those of a run without a
kill. Exit code 1 where something isn't so.
"""

import json
import math
import random
import re
import shutil
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


def journal_lines(folder):
    """Results by key in all journals. A last line that was cut off is none; any other broken line is
    an error, and so are two results of a run in one journal."""
    lines = {}
    for file in sorted(folder.glob("journal*.jsonl")):
        keys = set()
        for number, line in enumerate(file.read_bytes().split(b"\n")[:-1], 1):
            match = re.fullmatch(rb'\{"crc32":"([0-9a-f]{8})",(.*)', line)
            assert match and int(match[1], 16) == zlib.crc32(match[2]), f"{file}:{number}: broken"
            if number > 1:
                key = json.loads(line)["key"]
                assert key not in keys, f"{file}:{number}: {key} is there twice"
                keys.add(key)
                lines.setdefault(key, set()).add(line)
    return lines


class Study:
    """A study in a folder of its own, started again and again."""

    def __init__(self, kelpie, folder, out, parts):
        self.command = [kelpie, "study", "fleet.toml", "--threads", "1", "--out", out]
        self.folder = folder
        self.todo = [f"{k}/{parts}" for k in range(1, parts + 1)]

    def start(self):
        with open(self.folder / "said", "a", encoding="utf-8") as said:
            return [subprocess.Popen(self.command + ["--part", part], cwd=self.folder, stdout=said,
                                     stderr=said) for part in self.todo]

    def attack(self, dice, seconds):
        """Starts what is to be done, and kills a process unless all have ended before."""
        running = self.start()
        if seconds is not None:
            end = time.monotonic() + seconds
            while time.monotonic() < end and any(process.poll() is None for process in running):
                time.sleep(0.01)
            if victims := [process for process in running if process.poll() is None]:
                dice.choice(victims).kill()
        codes = [process.wait(timeout=600) for process in running]
        self.todo = [part for part, code in zip(self.todo, codes) if code != 0]

    def finish(self):
        subprocess.run(self.command + ["--merge"], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL)


def is_whole(checkpoint):
    data = checkpoint.read_bytes()
    return zlib.crc32(data[:-4]) == int.from_bytes(data[-4:], "little")


def kill_learning(kelpie, folder, most_kills, dice):
    """Returns the number of runs that it took."""
    def start(out):
        return subprocess.Popen(
            [kelpie, "learn", "dives/auv0/dive0.csv", "--set", "preset=small", "--set", "warmup=20",
             "--checkpoint-every", "20", "--resume", "--out", out],
            cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def results(out):
        result = json.loads((folder / out / "result.json").read_text())
        return without_times(result), (folder / out / "model.json").read_bytes()

    begin = time.monotonic()
    assert start("whole").wait(timeout=600) == 0
    usual_s = time.monotonic() - begin
    wanted = results("whole")
    kills = runs = 0
    while kills < most_kills:
        out, ended = f"learn{runs}", False
        runs += 1
        while not ended:
            process = start(out)
            try:
                ended = process.wait(timeout=dice.uniform(0.02, 0.6) * usual_s) == 0
                assert ended, f"{out}: ended with {process.returncode}"
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                kills += 1
            found = sorted((folder / out).glob("checkpoint*.kelpie"))
            assert not found or any(map(is_whole, found)), f"{out}: no whole checkpoint"
            if (folder / out / "result.json").exists():
                assert results(out) == wanted, f"{out}: another result"
        drafts = [file.name for file in (folder / out).iterdir() if file.name.endswith(".tmp")]
        assert not drafts, f"{out}: {drafts} stay"
        shutil.rmtree(folder / out)
    print(f"{runs} runs of learn, {kills} kills: every checkpoint whole, every result as undisturbed",
          flush=True)


def main():
    if len(sys.argv) < 2:
        return __doc__
    kelpie = str(Path(sys.argv[1]).resolve())
    studies, seed = map(int, (sys.argv[2:] + ["100", "1"][len(sys.argv) - 2:]))
    dice = random.Random(seed)
    folder = Path(tempfile.mkdtemp())
    write_study(folder)

    kill_learning(kelpie, folder, studies, dice)

    def result(out):
        return without_times(json.loads((folder / out / "study.json").read_text()))

    begin = time.monotonic()
    one = Study(kelpie, folder, "undisturbed", 2)
    one.attack(dice, None)
    assert not one.todo, (folder / "said").read_text()
    one.finish()
    usual_s = time.monotonic() - begin
    wanted = result("undisturbed")
    runs = len(journal_lines(folder / "undisturbed"))
    starts = kills = kept = 0
    for number in range(studies):
        out = f"study{number}"
        study = Study(kelpie, folder, out, dice.choice([2, 3]))
        before, left = {}, dice.randint(1, KILLS)
        while study.todo:
            seconds = dice.uniform(0.2, 0.9) * usual_s if left > 0 else None
            study.attack(dice, seconds)
            starts += 1
            after = journal_lines(folder / out)
            lost = [key for key, lines in before.items() if not lines <= after.get(key, set())]
            assert not lost, f"{out}: lost or changed: {lost}"
            if study.todo:
                assert seconds is not None, (folder / "said").read_text()
                kills += 1
                left -= 1
                kept += len(after) - len(before)
                before = after
        study.finish()
        assert len(after) == runs, f"{out}: {len(after)} runs, not {runs}"
        assert all(len(lines) == 1 for lines in after.values()), f"{out}: a run twice"
        assert result(out) == wanted, f"{out}: another result than the undisturbed study's"
        shutil.rmtree(folder / out)
    shutil.rmtree(folder)
    print(f"{studies} studies of {runs} runs, {starts} starts, {kills} kills, {kept} results kept "
          "over them: none lost, none twice, every journal readable, every result as undisturbed")
    return None


if __name__ == "__main__":
    sys.exit(main())
