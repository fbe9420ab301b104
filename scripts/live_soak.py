#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A day at sea: hours of a simulated vehicle with faults by `kelpie live` (docs/howto/live.md).

    /usr/bin/python3 scripts/live_soak.py KELPIE [HOURS [SEED [BEGIN]]]

KELPIE is the program, HOURS are of vehicle time (24), SEED places faults and changes (1), BEGIN is
Unix time (1700000000). Dagon is simulated at 4 Hz, its vehicle changes seven times; every five
minutes of the recording something goes wrong. What has to become of every row and message follows
from the faults: it is compared with the table that `kelpie live` prints at its end. Memory may not
grow by more than 5 % after the first hour (or half). Exit code 1 where something isn't as
expected. Files are left in out/live_soak, 200 MB for a day.
"""

import re
import sqlite3
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "out/live_soak"
RATE = GAP = 4  # rows per second, and messages of each topic; rows of `gap`, 1 s
SIGNALS = ["u", "v", "r", "th1", "th2", "th3"]
FIELDS = ["dvl:twist.linear.x", "dvl:twist.linear.y", "dvl:twist.angular.z",
          *(f"thrusters:velocity[{k}]" for k in range(3))]
STATES, COMMANDS = range(2)  # topics
LEARNED, INCOMPLETE, FROZEN, NONE = range(4)  # what becomes of a row
FOUND = ["without value", "with the stamp before", "out of order", "too late"]
FAULTS = ["states stop", "commands stop", "all stops", "states late", "order", "twice", "1970",
          "half the rate", "nan", "frozen"]
SLOT, LONGEST = 300 * RATE, 100 * RATE  # rows: one fault in each slot, and how long it may be
VEHICLES = ["", "effectiveness = { surge_left = 0.6 }", "effectiveness = { surge_right = 0.5 }",
            "damping_factor = [1.8, 1.6, 1.5, 1.3, 1.3, 1.5]", "effectiveness = { sway = 0.5 }"]
CONFIG = "\n".join([
    f'[log]\ninputs = {SIGNALS}\ntargets = ["udot", "vdot", "rdot"]\nrate = {RATE}',
    'clock = "header"\nwindow = 1.0\ndegree = 1\n[log.states]',
    *(f'{name} = "/{field}"' for name, field in zip(SIGNALS[:3], FIELDS)), "[log.commands]",
    *(f'{name} = "/{field}"' for name, field in zip(SIGNALS[3:], FIELDS[3:])), "[log.derived]",
    *(f'{name}dot = "d({name})"' for name in SIGNALS[:3]),
    '[live]\nalign = "none"\ncheckpoint = 600\nstatus = 1\n'])


def simulate(kelpie, hours, random):
    """Velocities and rotor speeds."""
    text = f'vehicle = "{ROOT}/vehicles/dagon.toml"\nrate_hz = {RATE}\nnoise = "as_recorded"\n'
    for k, line in enumerate(VEHICLES):
        text += f'[[configurations]]\nname = "{k}"\n{line}\n'
    shares = random.uniform(0.6, 1.4, 8)
    for k, seconds in enumerate(np.floor(3600 * hours * shares / shares.sum())):
        text += f'[[phases]]\nconfiguration = "{k % len(VEHICLES)}"\nduration_s = {seconds}\n'
        text += f"ramp_s = {seconds // 2 if k == 3 else 0}\namplitude = {0.5 if k == 5 else 1.0}\n"
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "day.toml").write_text(text)
    subprocess.run([kelpie, "simulate", FOLDER / "day.toml", "--out", FOLDER / "day.csv", "--seed",
                    str(random.integers(10**6))], check=True, stdout=subprocess.DEVNULL)
    return np.loadtxt(FOLDER / "day.csv", delimiter=",", skiprows=1, usecols=range(2, 8))


class Day:
    """What is sent, and what has to become of it. A fault begins at row i and lasts for n."""

    def __init__(self, values, begin_s):
        rows = len(values)
        self.values = values
        self.times_ns = begin_s * 10**9 + 10**9 // RATE * np.arange(rows)
        self.stamps_ns = self.times_ns.copy()
        self.sent = np.ones((2, rows), bool)
        self.twice = np.zeros(rows, bool)
        self.delay_ms = np.zeros((2, rows), int)
        self.rows = np.full(rows, LEARNED)
        self.rows[[0, -1]] = INCOMPLETE  # half a window
        self.restarts = 0
        self.found = np.zeros((len(FOUND), len(SIGNALS)), int)

    def spoil(self, fault, i, n):
        no_value, repeated, swapped, late = self.found
        if fault in ("states stop", "all stops", "states late", "nan"):
            self.rows[i - 1:i + n + 1] = INCOMPLETE  # a derivative ends one row before a silence
        if fault == "states stop":
            self.sent[STATES, i:i + n] = False
        elif fault == "commands stop":
            self.sent[COMMANDS, i:i + n] = False
            self.rows[i + GAP:i + n] = INCOMPLETE  # held for as long as `gap`
        elif fault == "all stops":
            self.sent[:, i:i + n] = False
            self.rows[i + GAP:i + n - GAP] = NONE
        elif fault == "states late":
            self.delay_ms[STATES, i:i + n] = 3000
            late[:3] += n
        elif fault == "order":
            self.delay_ms[COMMANDS, i:i + n:4] = 1000 // RATE + 10
            swapped[3:] += len(range(i, i + n, 4))
        elif fault == "twice":
            self.twice[i:i + n] = True
            repeated += n
        elif fault == "1970":  # believed with the last signal's eighth message, which is of use
            self.stamps_ns[i:i + n] = 100 * 10**9 + 10**9 // RATE * np.arange(n)
            self.rows[i - 2:i + 8] = NONE  # with the two that wait for half a window
            self.rows[[i + 8, i + n - 1, i + n]] = INCOMPLETE
            late += [8, 8, 8, 8, 8, 7]
            self.restarts += 1
        elif fault == "half the rate":
            self.sent[:, i + 1:i + n:2] = False
        elif fault == "nan":
            self.values[i:i + n, 0] = np.nan
            no_value[0] += n
        elif fault == "frozen":
            self.values[i:i + n, 1] = self.values[i - 1, 1]
            self.rows[i + GAP - 2:i + n + 2] = FROZEN  # as far as half a window reaches

    def compare(self, text):
        """Names, numbers expected, and those that kelpie has printed."""
        def number(pattern, where=text):
            return int((re.findall(pattern, where, re.MULTILINE) or [0])[0])
        learned, incomplete, frozen, _ = np.bincount(self.rows, minlength=4)
        yield "clock set back", self.restarts, number(r"^(\d+) times a clock")
        yield "rows learned", learned, number(r"^(\d+) samples learned")
        yield "rows frozen", frozen, number(r"^(\d+) rows with a stuck")
        incomplete += 2 * GAP * self.restarts  # near a jump there are rows without messages
        yield "rows incomplete", incomplete, number(r"^(\d+) rows with a value")
        unused = self.found[0] + self.found[3]
        for k, name in enumerate(SIGNALS):
            line = (re.findall(rf"^ *{name} .*$", text, re.MULTILINE) or [""])[0]
            yield f"{name}: samples", self.sent[k // 3].sum() - unused[k], number(r" (\d+)", line)
            for what, counts in zip(FOUND, self.found):
                yield f"{name}: {what}", counts[k], number(rf"(\d+) {what}", line)


def record(day):
    """A rosbag2 file of sqlite3: TwistStamped and JointState in CDR."""
    messages = []
    for i, (u, v, r, *speeds) in enumerate(day.values.tolist()):
        stamp = divmod(int(day.stamps_ns[i]), 10**9)
        head = struct.pack("<4BiII4s", 0, 1, 0, 0, *stamp, 4, b"dvl\0")
        for topic, data in enumerate([struct.pack("<6d", u, v, 0, 0, 0, r),
                                      struct.pack("<4I3dI", 0, 0, 3, 0, *speeds, 0)]):
            at_ns = int(day.times_ns[i]) + 10**6 * (int(day.delay_ms[topic, i]) + topic)
            for k in range(day.sent[topic, i] * (1 + day.twice[i])):
                messages.append((topic + 1, at_ns + 2 * 10**6 * k, head + data))
    (FOLDER / "day.db3").unlink(missing_ok=True)
    with sqlite3.connect(FOLDER / "day.db3") as bag:
        bag.executescript("""
            CREATE TABLE topics(id, name, type, serialization_format, offered_qos_profiles);
            CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data);
            INSERT INTO topics VALUES(1, '/dvl', 'geometry_msgs/msg/TwistStamped', 'cdr', ''),
                (2, '/thrusters', 'sensor_msgs/msg/JointState', 'cdr', '');""")
        bag.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                        sorted(messages, key=lambda message: message[1]))


def live(kelpie):
    """Exit code, what it printed, and (hours learned, memory, checkpoint), both in MB."""
    (FOLDER / "live.toml").write_text(CONFIG)
    # The blocks in which it reads the recording beforehand go back, rather than hide what grows.
    process = subprocess.Popen(
        [kelpie, "live", "--config", FOLDER / "live.toml", "--replay", FOLDER / "day.db3", "--speed",
         "max", "--fresh", "--out", FOLDER], text=True, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, env={"MALLOC_MMAP_THRESHOLD_": "131072"})
    text, sizes = "", []
    checkpoint = FOLDER / "checkpoint.kelpie"
    checkpoint.unlink(missing_ok=True)
    for line in process.stdout:
        text += line
        kb = re.search(r"VmRSS:\s*(\d+)", Path(f"/proc/{process.pid}/status").read_text())
        if (status := re.match(r"kelpie: [-\d.]+ s, ([\d,]+) learned", line)) and kb:
            hours = int(status[1].replace(",", "")) / RATE / 3600
            saved = checkpoint.stat().st_size / 1e6 if checkpoint.exists() else 0.0
            sizes.append((hours, int(kb[1]) * 1024 / 1e6, saved))
    (FOLDER / "live.txt").write_text(text)
    return process.wait(), text, sizes


def main():
    if len(sys.argv) < 2:
        return __doc__
    kelpie, *given = sys.argv[1:]
    hours, seed, begin_s = map(float, given + ["24", "1", "1700000000"][len(given):])
    day = Day(simulate(kelpie, hours, random := np.random.default_rng(int(seed))), int(begin_s))
    for k, slot in enumerate(range(0, len(day.rows) - SLOT + 1, SLOT)):
        n = 2 * int(random.integers(5 * RATE, LONGEST // 2))
        i = slot + int(random.integers(20 * RATE, SLOT - LONGEST - 20 * RATE))
        day.spoil(FAULTS[k % len(FAULTS)], i, n)
    record(day)
    code, text, sizes = live(kelpie)
    is_well = code == 0
    print(f"exit code {code}\n{'':28s}{'expected':>10s}{'found':>10s}")
    for name, expected, found in day.compare(text):
        is_well &= expected == found
        print(f"{name:28s}{expected:10d}{found:10d}{'' if expected == found else '  WRONG'}")
    after = min(1.0, hours / 2)
    memory, checkpoints = zip(*[mb for at, *mb in sizes if at >= after] or [[np.nan, np.nan]])
    is_well &= max(memory) <= 1.05 * memory[0]
    for name, later in ("memory", memory), ("checkpoint", checkpoints):
        print(f"{name}/MB: {later[0]:.1f} after {after:g} h, then up to {max(later):.1f}")
    return None if is_well else "something isn't as expected"


if __name__ == "__main__":
    sys.exit(main())
