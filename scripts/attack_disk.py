#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What disk and system may do to `kelpie live`: files cut and left over, a full disk, a folder that
cannot be written, few file descriptors, a second process, checkpoints of others (docs/howto/live.md).

    python3 scripts/attack_disk.py KELPIE [--seed 1]

Replays a small table, in folders of its own, for about a minute. Exit code 1 after one of: a signal,
an exit code other than expected, a message without the reason, a folder from which no later run goes
on.
"""

import argparse
import math
import os
import random
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

LIMIT_S = 60
FAULTS = []


def check(case, holds, run):
    if not holds:
        FAULTS.append(case)
        print("WRONG:", case, run.returncode, run.stderr[-500:], flush=True)


def table(rows):
    u, lines = 0.0, ["t,u,n,udot"]
    for k in range(rows):
        n = 10.0 * math.sin(0.013 * k) + 3.0 * math.sin(0.21 * k)
        udot = 0.01 * n * abs(n) - 2.0 * u * abs(u) - 0.3 * u
        lines.append(f"{0.1 * k:.1f},{u:.6f},{n:.6f},{udot:.6f}")
        u += 0.1 * udot
    return "\n".join(lines) + "\n"


class Room:
    def __init__(self, kelpie, folder):
        self.kelpie, self.folder = kelpie, folder
        (folder / "dive.csv").write_text(table(900))
        (folder / "other.csv").write_text(table(900).replace("t,u,n,", "t,v,m,"))
        (folder / "x.toml").write_text('[live]\nalign = "none"\ncheckpoint = 0.3\n')

    def command(self, *more, log="dive.csv", speed="max"):
        return [self.kelpie, "live", "--replay", log, "--config", "x.toml", "--set", "buffer=40",
                "--speed", speed, "--out", "out", *more]

    def run(self, *more, log="dive.csv", limits=()):
        def before():
            for limit, value in limits:
                resource.setrlimit(limit, (value, value))
        return subprocess.run(self.command(*more, log=log), cwd=self.folder, text=True,
                              capture_output=True, timeout=LIMIT_S, preexec_fn=before)

    def well(self, case):
        """A later run goes on, or begins anew where it is told to."""
        run = self.run()
        if run.returncode == 2 and "--fresh" in run.stderr:
            run = self.run("--fresh")
        check(case + ", later", run.returncode == 0, run)

    def expect(self, case, codes, words, *more, **how):
        run = self.run(*more, **how)
        check(case, run.returncode in codes
              and (run.returncode == 0 or any(word in run.stderr for word in words)), run)


def cut_files(room, chance):
    """Power is lost: the newest checkpoint is cut or wild, temporary files are left."""
    room.run("--fresh")
    out = room.folder / "out"
    newest, previous = out / "checkpoint.kelpie", out / "checkpoint.previous.kelpie"
    whole, earlier = newest.read_bytes(), previous.read_bytes()
    for length in [0, 1, 7, 64, len(whole) // 2, len(whole) - 1]:
        newest.write_bytes(whole[:length])
        previous.write_bytes(earlier)
        room.expect(f"cut to {length} bytes", (0, 2), ["--fresh"])
    for _ in range(10):
        wild = bytearray(whole)
        for _ in range(5):
            wild[chance.randrange(len(wild))] = chance.randrange(256)
        newest.write_bytes(wild)
        previous.write_bytes(earlier if chance.random() < 0.5 else wild[:100])
        room.expect("wild bytes", (0, 2), ["--fresh"])
    for name in ["checkpoint.kelpie", "model.json"]:
        (out / f"{name}.1-0.tmp").write_bytes(whole[:1000])
    room.expect("temporary files", (0, 2), ["--fresh"], "--fresh")
    check("temporary files are gone", not list(out.glob("*.tmp")), room.run("--check"))
    newest.unlink()
    newest.mkdir()
    room.expect("a folder in place of the checkpoint", (1, 2), ["checkpoint"])
    newest.rmdir()


def kills(room, chance):
    for _ in range(8):
        process = subprocess.Popen(room.command("--record", "rec", speed="30"), cwd=room.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(chance.uniform(0.05, 1.5))
        process.send_signal(signal.SIGKILL)
        process.wait()
        room.expect("after a kill", (0,), [], "--check")


def two_at_once(room, _chance):
    first = subprocess.Popen(room.command("--fresh", speed="10"), cwd=room.folder, text=True,
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    while not (room.folder / "out/.kelpie.lock").exists() and first.poll() is None:
        time.sleep(0.01)
    room.expect("a second process", (1, 2), ["out"])
    first.send_signal(signal.SIGINT)
    first.returncode = first.wait(LIMIT_S)
    check("the first process", first.returncode == 0, first)


def full_disk(room, _chance):
    for size in [0, 100, 4096, 50_000]:
        for more in [(), ("--record", "rec")]:
            room.expect(f"no file beyond {size} bytes {more}", (0, 1, 2),
                        ["File too large", "cannot be written"], *more, "--fresh",
                        limits=[(resource.RLIMIT_FSIZE, size)])


def few_descriptors(room, _chance):
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        page = f"127.0.0.1:{one.getsockname()[1]}"
    for most in [4, 5, 6, 7, 8, 12, 20]:  # with 3 the system finds no libraries
        room.expect(f"{most} file descriptors", (0, 1, 2),
                    ["Too many open files", "cannot be read", "cannot start", "isn't there"],
                    "--record", "rec", "--page", page, "--fresh",
                    limits=[(resource.RLIMIT_NOFILE, most)])


def read_only(room, _chance):
    """The system refuses root nothing: another user runs kelpie then."""
    shutil.rmtree(room.folder / "out", ignore_errors=True)
    (room.folder / "out").mkdir()
    room.folder.chmod(0o755)
    (room.folder / "out").chmod(0o555)

    def before():
        if os.getuid() == 0:
            os.setgroups([])
            os.setgid(65534)
            os.setuid(65534)
    run = subprocess.run(room.command(), cwd=room.folder, text=True, capture_output=True,
                         timeout=LIMIT_S, preexec_fn=before)
    check("a folder without permission", run.returncode == 1 and "ermission denied" in run.stderr,
          run)
    (room.folder / "out").chmod(0o755)


def checkpoints_of_others(room, _chance):
    room.run("--fresh")
    newest = room.folder / "out/checkpoint.kelpie"
    whole = newest.read_bytes()
    room.expect("another vehicle", (2,), ["--fresh"], log="other.csv")
    room.expect("another configuration", (2,), ["buffer"], "--set", "buffer=41")
    at = whole.find(b'"kelpie"')
    other = whole[:at] + whole[at:at + 60].replace(b".", b"9", 1) + whole[at + 60:]
    newest.write_bytes(other)
    (room.folder / "out/checkpoint.previous.kelpie").write_bytes(other)
    room.expect("another build", (0, 2), ["--fresh"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("kelpie")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    for attack in [cut_files, kills, two_at_once, full_disk, few_descriptors, read_only,
                   checkpoints_of_others]:
        with tempfile.TemporaryDirectory(prefix="kelpie_disk_") as folder:
            room = Room(str(Path(options.kelpie).resolve()), Path(folder))
            began, faults = time.monotonic(), len(FAULTS)
            attack(room, random.Random(options.seed))
            room.well(attack.__name__)
            print(f"{attack.__name__}: {'well' if len(FAULTS) == faults else 'WRONG'}, "
                  f"{time.monotonic() - began:.0f} s", flush=True)
    sys.exit(1 if FAULTS else 0)


if __name__ == "__main__":
    main()
