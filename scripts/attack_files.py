#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Conditions of the operating system, and hostile names, around the command kelpie.

    python3 scripts/attack_files.py KELPIE [CASE...]

KELPIE is the program. A CASE is a function attack_CASE below (all by default): no space on the disk,
no permission, no descriptors, files cut or left over, two processes in one folder, checkpoints of
another run, hostile names of columns and files, other environments, wide and sparse files. Every
command ends within two minutes of processor time, by an exit code (0, 1 or 2) and no signal, with a message of at most
2,000 letters where the code is not 0; what stood in the folder before is whole, and no draft of a
file is left. Exit code 1 where a rule is broken. Commands run as nobody where root starts the script.
"""

import argparse
import json
import os
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
import zipfile
import zlib
from pathlib import Path

SECONDS = 120  # of processor time: the machine may have other work
WAIT_SECONDS = 1200
MOST_SAID = 2100  # bytes: 2,000 and a line's beginning
LEARN = ["--set", "preset=small", "--set", "warmup=20", "--set", "buffer=30", "--align", "none"]
NAMES = ['quote"', "apo'strophe", "back\\slash", "*/ int x; /*", "]] end", "line\nfeed", "??/", "%s%n",
         "-dash", "$(id)", "<b>&amp;", "int", "end", "ü€\U0001F6A2", "a: {b}", "#", "nul", "\u202eturn",
         "k" * 300]


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
        self.run(["learn", "log.csv", *LEARN, "--out", "out", "--checkpoint-every", "100"], {0})

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
        require(len(done.stderr) <= MOST_SAID, "long: " + shown)
        require(done.returncode == 0 or done.stderr, "silent: " + shown)
        require(all(text.encode() in done.stderr for text in said), "unclear: " + shown)
        return done

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
        for words in WRITING.values():
            room.run(words, {1, 2}, said=["Permission denied"])
            room.expect_unchanged(before)
    finally:
        room.folder.chmod(0o777)
        (room.folder / "out").chmod(0o777)


def attack_no_descriptors(room):
    before = room.contents()
    for words in WRITING.values():
        for number in range(4, 10):  # with less, the program is not even loaded
            done = room.run(words, limit=(resource.RLIMIT_NOFILE, number))
            if done.returncode != 0:
                room.expect_unchanged(before)
            before = room.contents()


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


def attack_two_at_once(room):
    words = [room.kelpie, "learn", "log.csv", "--align", "none", "--out", "both"]
    (room.folder / "log.csv").write_text(log(3000))
    both = [subprocess.Popen(words, cwd=room.folder, user=room.user, stderr=subprocess.PIPE,
                             stdout=subprocess.DEVNULL) for _ in range(2)]
    said = [one.communicate(timeout=WAIT_SECONDS)[1] for one in both]
    codes = sorted(one.returncode for one in both)
    require(codes in ([0, 1], [0, 2]), f"{codes}: {said}")
    json.loads((room.folder / "both/result.json").read_text())


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


def attack_names(room):
    """Columns of hostile names, learned, and exported to every format; and names within a model.json
    that no log can have."""
    for name in NAMES:
        for names in ((name, "n", "udot"), ("u", name, "udot"), ("u", "n", name)):
            (room.folder / "names.csv").write_text(log(300, names))
            inputs, target = (json.dumps(what, ensure_ascii=False) for what in (names[:2], names[2]))
            (room.folder / "names.toml").write_text(
                f'[log]\ntime = "t"\ninputs = {inputs}\ntargets = [{target}]\n')
            shutil.rmtree(room.folder / "out2", ignore_errors=True)
            done = room.run(["learn", "names.csv", *LEARN, "--config", "names.toml", "--out", "out2"],
                            {2} if "\n" in name else {0})
            if done.returncode == 0:
                check_exports(room, name)
        shutil.copytree(room.folder / "out", room.folder / "out2", dirs_exist_ok=True)
        model = json.loads((room.folder / "out/model.json").read_text())
        model["inputs"][1] = name
        model["axes"][0]["target"] = name + "_dot"
        (room.folder / "out2/model.json").write_text(json.dumps(model))
        check_exports(room, name)


def check_exports(room, name):
    for file in (room.folder / "out2").glob("*.json"):
        json.loads(file.read_text())
    try:
        import yaml
        for file in (room.folder / "out2").glob("*.yaml"):
            yaml.safe_load(file.read_text())
    except ImportError:
        pass
    for file in (room.folder / "out2").glob("*.xml"):
        ElementTree.parse(file)
    for file in (room.folder / "out2").glob("*.lua"):
        if shutil.which("luac"):
            compiled = subprocess.run(["luac", "-p", file], capture_output=True, check=False)
            require(compiled.returncode == 0, f"{name!r}: {compiled.stderr[:300]!r}")
    for more in ([], ["--assess", "--hessian"], ["--casadi"]):
        room.run(["export", "out2/model.json", "--c", "m.c", "--header", "m.h", *more], {0})
        if shutil.which("cc"):
            compiled = subprocess.run(
                ["cc", "-std=c99", "-Wall", "-Werror", "-Wno-unused", "-c", "m.c", "-o", "/dev/null"],
                cwd=room.folder, capture_output=True, check=False)
            require(compiled.returncode == 0, f"{name!r}: {compiled.stderr[:300]!r}")
    if room.run(["export", "out2/model.json", "--fmu", "m.fmu"]).returncode == 0:
        with zipfile.ZipFile(room.folder / "m.fmu") as unit:
            ElementTree.fromstring(unit.read("modelDescription.xml"))


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
