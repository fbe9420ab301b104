#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Conditions of the operating system around the commands of kelpie and around `kelpie live`.

    python3 scripts/attack_files.py KELPIE [CASE...]

KELPIE is the program. A CASE is a function attack_CASE below (all by default): no space on the disk,
no permission, no descriptors, files cut or left over, kills, two processes in one folder, checkpoints
of another run, hostile names of files, other environments, wide and sparse files. Every command ends
within two minutes of processor time, by an exit code (0, 1 or 2) and no signal, with a message of at
most 2,000 letters where the code is not 0; what stood in the folder before is whole, no draft of a
file is left, and a later `kelpie live` goes on, or begins anew where its message says --fresh. Exit
code 1 where a rule is broken. Commands run as nobody where root starts the script.
"""

import argparse
import json
import os
import random
import resource
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

SECONDS = 120  # of processor time: the machine may have other work
WAIT_SECONDS = 1200
MOST_SAID = 2100  # bytes: 2,000 and a line's beginning
LEARN = ["--set", "preset=small", "--set", "warmup=20", "--set", "buffer=30", "--align", "none"]
LIVE = ["live", "--replay", "log.csv", "--config", "live.toml", *LEARN[:-2], "--out", "live"]


class Broken(Exception):
    """A rule is broken."""


def require(holds, what):
    if not holds:
        raise Broken(what)


def cell(text):
    return '"' + text.replace('"', '""') + '"'


def log(rows, names=("u", "n", "udot")):
    lines = [",".join(map(cell, ("t", *names)))]
    for k in range(rows):
        u, n = (k * 7919 % 97) / 97, (k * 104729 % 89) / 9
        lines.append(f"{0.1 * k:.1f},{u:.4f},{n:.3f},{u / 2 - n / 9:.5f}")
    return "\n".join(lines) + "\n"


class Room:
    """A folder with a log, a model learned from the log, and commands in it."""

    def __init__(self, kelpie, folder):
        self.kelpie, self.folder = kelpie, folder
        self.user = 65534 if os.getuid() == 0 else None
        folder.chmod(0o777)
        (folder / "log.csv").write_text(log(300))
        (folder / "live.toml").write_text('[live]\nalign = "none"\ncheckpoint = 0.3\n')
        self.run(["learn", "log.csv", *LEARN, "--out", "out", "--checkpoint-every", "100"], {0})
        self.live()

    def run(self, words, codes=(0, 1, 2), *, said=(), limit=None, env=None, umask=0o022):
        def prepare():
            os.umask(umask)
            resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
            if limit:
                resource.setrlimit(limit[0], (limit[1], limit[1]))
        done = subprocess.run(
            [self.kelpie, *words], cwd=self.folder, stdin=subprocess.DEVNULL, timeout=WAIT_SECONDS,
            capture_output=True, preexec_fn=prepare, env=env, user=self.user, check=False)
        shown = f"{' '.join(map(str, words))[:200]!r}: {done.returncode}: {done.stderr[:400]!r}"
        require(done.returncode in codes, shown)
        require(done.returncode == 0 or len(done.stderr) <= MOST_SAID, "long: " + shown)
        require(done.returncode == 0 or done.stderr, "silent: " + shown)
        require(all(text.encode() in done.stderr for text in said), "unclear: " + shown)
        return done

    def live(self, *more, said=("--fresh",), codes=(0, 1, 2), **how):
        """`kelpie live` as quick as it can; where it fails, with one of these words."""
        done = self.run([*LIVE, "--speed", "max", *more], codes, **how)
        require(done.returncode == 0 or any(word.encode() in done.stderr for word in said),
                f"live {more}: unclear: {done.stderr[-400:]!r}")
        return done

    def live_goes_on(self):
        """A later run goes on, or begins anew where it says so."""
        if self.live().returncode != 0:
            self.live("--fresh", codes={0})

    def start(self, words):
        return subprocess.Popen([self.kelpie, *words], cwd=self.folder, user=self.user,
                                stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)

    def contents(self):
        return {str(f.relative_to(self.folder)): f.read_bytes()
                for f in sorted(self.folder.rglob("*")) if f.is_file()}

    def expect_unchanged(self, before, may_be_new=()):
        """Whole are the files that stood here, and none is new but those that may be."""
        now = self.contents()
        changed = [name for name in before if now.get(name) != before[name]]
        new = [name for name in now if name not in before and name not in may_be_new]
        require(not changed and not new, f"changed {changed}, left {new}")


WRITING = {  # commands by what they write
    "out/result.json": ["learn", "log.csv", *LEARN, "--out", "out"],
    "p.csv": ["predict", "log.csv", "--model", "out/model.json", "--out", "p.csv"],
    "m.c": ["export", "out/model.json", "--c", "m.c"],
    "m.fmu": ["export", "out/model.json", "--fmu", "m.fmu"],
    "c": ["compare", "log.csv", "--align", "none", "--out", "c"],
}


def attack_full_disk(room):
    before = room.contents()
    for words in WRITING.values():
        for size in (0, 100, 4096):
            # A folder may be there, empty, and the lock of a folder in it.
            done = room.run(words, limit=(resource.RLIMIT_FSIZE, size))
            if done.returncode != 0:
                room.expect_unchanged(before)
            else:
                shutil.rmtree(room.folder)
                raise Broken(f"{words}: writes within {size} bytes")
    for size in (0, 100, 4096, 50_000):
        for more in ([], ["--record", "rec"]):
            room.live("--fresh", *more, said=["File too large", "cannot be written"],
                      limit=(resource.RLIMIT_FSIZE, size))
            room.live_goes_on()


def attack_no_permission(room):
    before = room.contents()
    if room.user is not None:
        for path in (room.folder, *room.folder.rglob("*")):
            os.chown(path, 0, 0)
            path.chmod(0o755 if path.is_dir() else 0o644)
    else:
        for path in (room.folder, *(p for p in room.folder.rglob("*") if p.is_dir())):
            path.chmod(0o555)
    try:
        for words in (*WRITING.values(), [*LIVE, "--speed", "max"]):
            room.run(words, {1, 2}, said=["Permission denied"])
            room.expect_unchanged(before)
    finally:
        for path in (room.folder, room.folder / "out", room.folder / "live"):
            path.chmod(0o777)


def attack_no_descriptors(room):
    before = room.contents()
    for words in WRITING.values():
        for number in range(4, 10):  # with less, the program is not even loaded
            done = room.run(words, limit=(resource.RLIMIT_NOFILE, number))
            if done.returncode != 0:
                room.expect_unchanged(before)
            before = room.contents()
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        page = f"127.0.0.1:{one.getsockname()[1]}"
    for number in (4, 5, 6, 7, 8, 12, 20):
        room.live("--fresh", "--record", "rec", "--page", page,
                  said=["Too many open files", "cannot be read", "cannot start", "isn't there"],
                  limit=(resource.RLIMIT_NOFILE, number))
        room.live_goes_on()


def attack_leftovers(room):
    checkpoint = room.folder / "out/checkpoint.kelpie"
    whole = checkpoint.read_bytes()
    again = [*WRITING["out/result.json"], "--checkpoint-every", "100", "--resume"]
    for cut in (0, 1, len(whole) // 2, len(whole) - 1):
        checkpoint.write_bytes(whole[:cut])
        room.run(again, {0, 2})
    for name in ("result.json.1-2.tmp", "checkpoint.kelpie.77-link.tmp"):
        (room.folder / "out" / name).write_text("left over")
    shutil.rmtree(room.folder / "out")
    (room.folder / "out").mkdir()
    (room.folder / "out").chmod(0o777)
    (room.folder / "out/result.json.1-2.tmp").write_text("left over")
    (room.folder / "out/result.json.1-2.tmp").chmod(0o666)
    room.run(WRITING["out/result.json"], {0})
    require(not list((room.folder / "out").glob("*.tmp")), "a draft is left")
    leave_live_files(room, random.Random(1))


def leave_live_files(room, dice):
    """Power is lost: the newest checkpoint is cut or wild, drafts are left."""
    newest, previous = (room.folder / "live" / name
                        for name in ("checkpoint.kelpie", "checkpoint.previous.kelpie"))
    room.live("--fresh", codes={0})
    whole, earlier = newest.read_bytes(), previous.read_bytes()
    wild = [bytearray(whole) for _ in range(10)]
    for one in wild:
        for _ in range(5):
            one[dice.randrange(len(one))] = dice.randrange(256)
    for left in [*(whole[:cut] for cut in (0, 1, 7, 64, len(whole) // 2, len(whole) - 1)), *wild]:
        newest.write_bytes(left)
        previous.write_bytes(earlier if dice.random() < 0.5 else left[:100])
        for name in ("checkpoint.kelpie.1-0.tmp", "model.json.1-0.tmp"):
            draft = room.folder / "live" / name
            draft.write_bytes(whole[:1000])
            draft.chmod(0o666)
        room.live(codes={0, 2})
    room.live("--fresh", codes={0})
    require(not list(newest.parent.glob("*.tmp")), "live: a draft is left")
    newest.unlink()
    newest.mkdir()
    room.live(codes={1, 2}, said=["checkpoint"])
    newest.rmdir()
    room.live_goes_on()


def attack_kills(room):
    """Of `kelpie live`; tests/tools/cli/checkpoint_test.cpp kills `kelpie learn`."""
    dice = random.Random(1)
    for _ in range(8):
        process = room.start([*LIVE, "--record", "rec", "--speed", "30"])
        time.sleep(dice.uniform(0.05, 1.5))
        process.kill()
        process.communicate()
        room.live("--check", codes={0})
    room.live_goes_on()


def attack_two_at_once(room):
    (room.folder / "log.csv").write_text(log(3000))
    both = [room.start(["learn", "log.csv", "--align", "none", "--out", "both"]) for _ in range(2)]
    said = [one.communicate(timeout=WAIT_SECONDS)[1] for one in both]
    codes = sorted(one.returncode for one in both)
    require(codes in ([0, 1], [0, 2]), f"{codes}: {said}")
    json.loads((room.folder / "both/result.json").read_text())
    first = room.start([*LIVE, "--fresh", "--speed", "10"])
    lock = room.folder / "live/.kelpie.lock"
    while not lock.exists() and first.poll() is None:
        time.sleep(0.01)
    room.live(codes={1, 2}, said=["live"])
    first.send_signal(signal.SIGINT)
    said = first.communicate(timeout=WAIT_SECONDS)[1]
    require(first.returncode == 0, f"the first: {first.returncode}: {said[-400:]!r}")
    room.live_goes_on()


def attack_other_checkpoints(room):
    checkpoint = room.folder / "out/checkpoint.kelpie"
    whole = checkpoint.read_bytes()
    again = [*WRITING["out/result.json"], "--checkpoint-every", "100", "--resume"]
    room.run([*again, "--set", "buffer=31"], {2}, said=["buffer"])
    (room.folder / "other.csv").write_text(log(400))
    room.run(["learn", "other.csv", *again[2:]], {2}, said=["checkpoint"])
    other = whole[:-4].replace(b'"kelpie-checkpoint"', b'"kelpie-checkpoinu"', 1)
    (room.folder / "out/checkpoint.previous.kelpie").unlink(missing_ok=True)
    checkpoint.write_bytes(other + struct.pack("<I", zlib.crc32(other)))
    room.run(again, {2}, said=["checkpoint.kelpie: "])
    # The model's own version stands behind the header, as a text: one that no build has.
    at = whole.index(b"\n}") + 2
    at = next(k for k in range(at, len(whole)) if whole[k:k + 2].isdigit())
    other = whole[:at] + b"99" + whole[at + 2:-4]
    checkpoint.write_bytes(other + struct.pack("<I", zlib.crc32(other)))
    room.run(again, {2}, said=["checkpoint.kelpie: ", "99"])
    room.live("--set", "buffer=41", codes={2}, said=["buffer"])
    (room.folder / "log.csv").write_text(log(300, ("v", "m", "vdot")))
    room.live(codes={2})
    room.live_goes_on()


def attack_file_names(room):
    for name in ("a\nkelpie: all is well", "quo'te\".csv", "-dash.csv", "--out", "sp ace", "ü.csv",
                 "\udcff.csv", "%s", "*"):
        (room.folder / name).write_text(log(300))
        done = room.run(["inspect", "./" + name], {0})
        require(b"\nkelpie: all is well" not in done.stderr, f"{name!r}")
        room.run(["learn", "./" + name, *LEARN, "--out", "./d/" + name], {0})
        room.run(["inspect", "./no" + name], {2})
        (room.folder / name).unlink()


def attack_environments(room):
    usual = {"PATH": os.environ["PATH"]}
    whole = None
    for change in ({}, {"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE"}, {"TZ": "Asia/Kathmandu"},
                   {"HOME": "/nowhere"}, {"TMPDIR": "/nowhere"}, {"COLUMNS": "-1"}):
        room.run(WRITING["out/result.json"], {0}, env=usual | change, umask=0o077)
        model = (room.folder / "out/model.json").read_bytes()
        whole = whole or model
        require(model == whole, f"{change}: another model")


def attack_wide(room):
    names = ["t", *(f"x{k}" for k in range(9_999))]
    rows = ["0." + str(k) + ",1" * 9_999 for k in range(20)]
    (room.folder / "wide.csv").write_text("\n".join([",".join(names), *rows]) + "\n")
    room.run(["inspect", "wide.csv"], {0})
    room.run(["learn", "wide.csv", *LEARN, "--out", "w"], {2})
    room.run(["config", "wide.csv", "--out", "w.toml"])


def attack_sparse(room):
    heads = {"csv": b"t,u\n", "db3": b"SQLite format 3\0", "mcap": b"\x89MCAP0\r\n",
             "bag": b"#ROSBAG V2.0\n", "BIN": b"\xa3\x95\x80\x80\x59", "ulg": b"ULog\x01\x12\x35\x01",
             "alog": b"%% LOG FILE: x\n%% LOGSTART 1000\n", "mat": b"MATLAB 5.0 MAT-file",
             "toml": b"[log]\n", "json": b"{"}
    for ending, head in heads.items():
        file = room.folder / f"sparse.{ending}"
        file.write_bytes(head)
        os.truncate(file, 4 << 30)
        words = ["learn", "log.csv", "--config", file.name] if ending == "toml" else \
            ["predict", "log.csv", "--model", file.name] if ending == "json" else \
            ["inspect", file.name]
        room.run(words, {2}, said=["sparse." + ending])
        file.unlink()


ROWS = """
import resource, sys
import numpy as np
import kelpie
random = np.random.default_rng(1)
model, rows = kelpie.DynamicsModel(terms="none", buffer=30, anchors=10, warmup=20), 0
for wanted in (100_000, 1_000_000, 2_000_000):
    while rows < wanted:
        X = random.normal(size=(20_000, 2))
        model.partial_fit(X, (X[:, :1] - X[:, 1:]), 0.1 * np.arange(rows, rows + len(X)))
        rows += len(X)
    print(rows, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def attack_many_rows(room):
    """A learner's memory after 100,000, 1 and 2 million rows; needs kelpie on the PYTHONPATH."""
    if subprocess.run([sys.executable, "-c", "import kelpie"], capture_output=True, check=False,
                      cwd=room.folder).returncode != 0:
        print("many_rows: left out: no module kelpie")
        return
    done = subprocess.run([sys.executable, "-c", ROWS], capture_output=True, text=True, check=True,
                          cwd=room.folder, timeout=WAIT_SECONDS)
    kb = [int(line.split()[1]) for line in done.stdout.splitlines()]
    print("many_rows:", done.stdout.replace("\n", " kB; "))
    require(kb[-1] < kb[0] + 5_000, f"grows: {kb} kB")


def main():
    cases = {name[len("attack_"):]: case for name, case in globals().items()
             if name.startswith("attack_")}
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kelpie")
    parser.add_argument("cases", nargs="*", choices=[[], *cases], default=[])
    options = parser.parse_args()
    broken = 0
    for name in options.cases or cases:
        with tempfile.TemporaryDirectory() as folder:
            try:
                cases[name](Room(str(Path(options.kelpie).resolve()), Path(folder)))
                print(f"{name}: kept", flush=True)
            except (Broken, subprocess.TimeoutExpired) as error:
                broken += 1
                print(f"{name}: BROKEN: {error}", flush=True)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
