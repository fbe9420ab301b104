#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Damaged files of every kind, given to the command kelpie (src/logs/bag/README.md).

    python3 scripts/mutate.py KELPIE [--mutants 3000] [--seed 1] [--jobs 2] [--seconds 3600]
                              [--keep FOLDER] [KIND...]

KELPIE is the program kelpie_in_a_row, a target of its own. Of each KIND (all: --list names them)
MUTANTS files are made from the small files in tests/ and from files that KELPIE writes: bytes
flipped, cut, copied, numbers replaced by extreme ones, and checksums set right again for half of
those that have one. A mutant breaks a rule where the command ends by a signal or a sanitizer's
report, takes more than 10 s of processor time or 60 s, more than 300 MB beyond the same command with
the whole file, ends with another exit code than 0 or 2 (for studies also 1: a run failed), or ends
with 2 and names no file. Such mutants are kept in FOLDER and counted; exit code 1 where there is one.
SECONDS bounds the time of a kind.

A start with sanitizers takes ten times as long as a small file, so 50 mutants share a process, which
is held to the bounds of one. Where a rule breaks, each of the 50 gets a process of its own.
"""

import argparse
import gzip
import os
import random
import re
import resource
import shutil
import signal
import sqlite3
import struct
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent / "tests"
CORPORA = TESTS / "fuzz"
MOST_SECONDS = 10  # of processor time: the machine may have other work
MOST_WAIT_SECONDS = 60.0
MOST_MEMORY_KB = 300 * 1024
ROW = 50  # mutants in a process
REPORTS = (b"AddressSanitizer", b"LeakSanitizer", b"runtime error:", b"terminate called")
LEARN = "--set preset=small --set warmup=20 --set buffer=30"
NUMBERS = (b"1e308", b"-1e308", b"-0.0", b"nan", b"inf", b"-inf", b"0", b"-1", b"1e18", b"1e-320",
           b"18446744073709551616", b"9223372036854775807", b"4294967295", b"2147483648", b"65536",
           b"0.5", b"1e9", b"1e5", b"1000", b"''", b"\"\"", b"[]", b"{}", b"[[[[[[", b"null")
WORDS = (b"u*u*u*u", b"|u|", b"\xff\xfe", b"\0", b"\n", b"=", b"[", b"]]", b"{", b"}", b"\"", b"'",
         b",", b":", b"#", b"../../", b"auto", b"none", b"true")


# Mutation.

def mutate_bytes(data, dice):
    at = dice.randrange(len(data) + 1)
    length = dice.choice((1, 2, 4, 8, 16, 64, 300))
    kind = dice.randrange(7)
    if kind == 0 and at < len(data):
        data[at] ^= 1 << dice.randrange(8)
    elif kind == 1:
        width, value = dice.choice(((1, 0xFF), (2, 0xFFFF), (4, 0xFFFFFFFF), (4, 0x7FFFFFFF),
                                    (8, 2**64 - 1), (8, 2**63 - 1), (8, 2**32), (4, 0x80000000),
                                    (4, 0), (8, 0), (4, 1 << 20), (4, len(data)), (2, 0x8000)))
        data[at:at + width] = value.to_bytes(width, dice.choice(("little", "big")))
    elif kind == 2:
        del data[at:at + length]
    elif kind == 3:
        data[at:at] = data[dice.randrange(len(data) + 1):][:length]
    elif kind == 4:
        data[at:at + length] = dice.randbytes(length)
    elif kind == 5 and dice.random() < 0.3:
        del data[at:]
    else:
        data[at:at + length] = bytes([dice.choice((0, 1, 0x20, 0x7F, 0x80, 0xFF))]) * length


def mutate_text(data, dice):
    tokens = list(re.finditer(rb"-?\d[\d.eE+-]*|\w+|[^\w\s]", data))
    if not tokens:
        mutate_bytes(data, dice)
        return
    token = dice.choice(tokens)
    is_number = token.group()[:1] in b"-0123456789"
    kind = dice.randrange(6)
    if kind <= 2:
        other = dice.choice(NUMBERS if is_number or dice.random() < 0.3 else WORDS)
    elif kind == 3:
        other = dice.choice(tokens).group()
    elif kind == 4:
        other = token.group() * dice.choice((2, 3, 50, 2000))
    else:
        other = b""
    data[token.start():token.end()] = other


def mutated(data, dice, is_text):
    data = bytearray(data)
    numbers = list(re.finditer(rb"-?\b\d[\d.eE+-]*", data)) if is_text else []
    if numbers and dice.random() < 0.5:  # sound but for a number
        number = dice.choice(numbers)
        data[number.start():number.end()] = dice.choice(NUMBERS)
        return bytes(data)
    for _ in range(dice.choice((1, 1, 1, 2, 3, 8))):
        (mutate_text if is_text and dice.random() < 0.7 else mutate_bytes)(data, dice)
    return bytes(data)


def with_checkpoint_sum(data):
    return data[:-4] + struct.pack("<I", zlib.crc32(data[:-4])) if len(data) > 4 else data


def with_journal_sums(data):
    def line_with_sum(line):
        match = re.match(rb'\{"crc32":"[0-9a-f]{8}",(.*)', line, re.DOTALL)
        return b'{"crc32":"%08x",%s' % (zlib.crc32(match[1]), match[1]) if match else line
    return b"\n".join(map(line_with_sum, data.split(b"\n")))


def repacked(data):
    return gzip.compress(data, 1)


# Whole files.

def little_log(rows=300):
    return (TESTS / "fuzz/corpus_csv/comma.csv").read_bytes() if rows == 0 else "\n".join(
        ["t,u,n,udot"] + [f"{0.1 * k:.1f},{(k * 7919 % 97) / 97:.4f},{(k * 104729 % 89) / 9:.3f},"
                          f"{(k * 7919 % 97) / 50 - (k * 104729 % 89) / 80:.5f}"
                          for k in range(rows)]).encode() + b"\n"


def sqlite_bag(folder):
    file = folder / "whole.db3"
    with sqlite3.connect(file) as bag:
        bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT,"
                    " serialization_format TEXT, offered_qos_profiles TEXT)")
        bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER,"
                    " timestamp INTEGER, data BLOB)")
        bag.execute("INSERT INTO topics VALUES(1, '/u', 'std_msgs/msg/Float64', 'cdr', '')")
        bag.execute("INSERT INTO topics VALUES(2, '/cmd', 'geometry_msgs/msg/Twist', 'cdr', '')")
        for k in range(60):
            bag.execute("INSERT INTO messages VALUES(NULL, 1, ?, ?)",
                        (k * 10**8, b"\0\1\0\0" + struct.pack("<d", k * 0.1)))
            bag.execute("INSERT INTO messages VALUES(NULL, 2, ?, ?)",
                        (k * 10**8, b"\0\1\0\0" + struct.pack("<6d", *range(k, k + 6))))
    bag.close()
    return file


CONFIG = b"""preset = "small"
warmup = 20
buffer = 30
gamma = 0.5
epsilon = 0.05
c = 10.0
terms = "u*|u|; n*|n|; u"
forget = "age"
coverage = 0.9

[log]
time = "t"
rate = 10
states = {u = "u"}
commands = {n = "n"}
derived = {udot = "d(u)"}
inputs = ["u", "n"]
targets = ["udot"]
gap = 1.0
window = 0.8
degree = 2
filter = "centred"
lag = {n = 0.1}
lag_part = 0.5
units = {u = "m/s"}
"""
SCENARIO = b"""vehicle = "dagon.toml"
seed = 3
rate_hz = 4.0
noise = "as_recorded"
current_m_s = [0.1, 0.0, 0.0]

[excitation]
mode = "correlated"
period_s = [20.0, 70.0]
correlation = 0.78

[[configurations]]
name = "A"

[[configurations]]
name = "B"
effectiveness = {sway = 0.5}
damping_factor = [1.0, 1.0, 1.0, 1.0, 1.0, 1.2]
pull_n = [1.0, 0.0, 0.0]
sensors = {scale = [1.0, 1.1, 1.0], bias = [0.0, 0.0, 0.01], frozen = [0, 0, 0]}
payload = {mass_kg = 2.0, position_m = [0.3, 0.0, 0.1], buoyancy_n = 15.0}

[[phases]]
configuration = "A"
duration_s = 20.0

[[phases]]
configuration = "B"
duration_s = 20.0
amplitude = 0.8
ramp_s = 5.0
"""
STUDY = b"""logs = "dives/*.csv"
splits = ["pieces", "random"]
seeds = 2
align = 0.1

[log]
time = "t"

[[learner]]
name = "small"
preset = "small"
set = {warmup = 20, buffer = 30}
"""


class Kind:
    """Files of a kind, and the command that reads one. `command` has {f}: the mutant, {o}: a folder
    of its own for what is written, {w}: the folder with the whole files. Errors may name `others`
    in place of the mutant."""

    def __init__(self, files, command, *, is_text=False, repair=None, place="{o}/mutant{e}",
                 codes=(0, 2), usual=lambda data: True, others=()):
        self.files, self.command, self.is_text, self.repair = files, command, is_text, repair
        self.place, self.codes, self.usual, self.others = place, codes, usual, others


def is_short_drive(data):
    """A long drive is work that was asked for, and no hang."""
    try:
        phases = tomllib.loads(data.decode())["phases"]
        return sum(phase["duration_s"] for phase in phases) <= 3000.0
    except Exception:  # pylint: disable=broad-except
        return True  # it has to be refused


def is_small_study(data):
    found = re.findall(rb"seeds\s*=\s*(\d+)", data)
    return not found or len(found[-1]) > 4 or int(found[-1]) in (*range(10), *range(1001, 10000))


def run(command, cwd):
    subprocess.run(command, cwd=cwd, shell=True, check=True, stdout=subprocess.DEVNULL)


def make_kinds(kelpie, folder):
    """Writes the whole files; returns the kinds by name."""
    (folder / "log.csv").write_bytes(little_log())
    (folder / "config.toml").write_bytes(CONFIG)
    (folder / "scenario.toml").write_bytes(SCENARIO)
    shutil.copy(TESTS.parent / "vehicles/dagon.toml", folder / "dagon.toml")
    (folder / "dives").mkdir()
    (folder / "dives/a.csv").write_bytes(little_log())
    (folder / "study.toml").write_bytes(STUDY)
    run(f"{kelpie} learn log.csv {LEARN} --align none --memory memory.json --out run --checkpoint-every 100",
        folder)
    run(f"{kelpie} study study.toml --out study --threads 1", folder)
    journal = next((folder / "study").glob("journal*.jsonl"))

    def corpus(name, *more):
        return sorted(p for p in (CORPORA / f"corpus_{name}").iterdir()) + list(more)

    fixtures = sorted((TESTS / "logs/bag/fixtures").iterdir())
    inspect = "inspect {f} {recover}"
    learn = f"learn {{w}}/log.csv {LEARN} --align none"
    kinds = {name: Kind(corpus(name), inspect)
             for name in ("alog", "dataflash", "ros1", "tlog", "ulog")}
    mats = corpus("mat")
    return kinds | {
        "mcap": Kind(corpus("bag") + fixtures, inspect),
        "db3": Kind([sqlite_bag(folder)], inspect),
        "mat": Kind([f for f in mats if b"HDF" not in f.read_bytes()[512:520]], inspect),
        "mat73": Kind([CORPORA / "corpus_mat/version73.mat"], inspect),
        "csv": Kind(corpus("csv", folder / "log.csv"), "inspect {f}", is_text=True),
        "csv_learn": Kind([folder / "log.csv"],
                          f"learn {{f}} {LEARN} --align none --out {{o}}/out", is_text=True),
        "csv_gz": Kind([folder / "log.csv"], "inspect {f}", is_text=True, repair=repacked),
        "model": Kind([folder / "run/model.json"],
                      "predict {w}/log.csv --model {f} --out {o}/p.csv", is_text=True),
        "model_export": Kind([folder / "run/model.json"], "export {f} --c {o}/m.c", is_text=True),
        "memory": Kind([folder / "memory.json"], learn + " --memory {f} --out {o}/out",
                       is_text=True),
        "config": Kind([folder / "config.toml"],
                       "learn {w}/log.csv --config {f} --align none --out {o}/out", is_text=True,
                       others=["log.csv"]),  # which a configuration may not fit
        "scenario": Kind([folder / "scenario.toml"], "simulate {f} --out {o}/s.csv", is_text=True,
                         usual=is_short_drive, place="{w}/mutant_{n}{e}"),
        "vehicle": Kind([folder / "dagon.toml"], "simulate {o}/scenario.toml --out {o}/s.csv",
                        is_text=True, place="{o}/dagon.toml", others=["scenario.toml"]),
        "study": Kind([folder / "study.toml"], "study {f} --out {o}/out --threads 1", is_text=True,
                      codes=(0, 1, 2), usual=is_small_study, place="{w}/mutant_{n}{e}"),
        "journal": Kind([journal], "study {w}/study.toml --out {o} --threads 1",
                        is_text=True, repair=with_journal_sums, place="{o}/" + journal.name),
        "checkpoint": Kind([folder / "run/checkpoint.kelpie"],
                           learn + " --resume --checkpoint-every 100 --out {o}",
                           repair=with_checkpoint_sum, place="{o}/checkpoint.kelpie"),
        "checkpoint_from": Kind([folder / "run/checkpoint.kelpie"],
                                "learn {w}/log.csv --align none --from {f} --out {o}/out",
                                repair=with_checkpoint_sum),
    }


class Ended:
    """How a process ended that ran a row of commands."""

    def __init__(self, kelpie, folder, commands):
        (folder / "lines").write_text("".join(commands))
        process = subprocess.Popen(f"ulimit -t {MOST_SECONDS}; exec {kelpie} <lines", shell=True,
                                   cwd=folder, stderr=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL)
        timer = threading.Timer(MOST_WAIT_SECONDS, os.kill, (process.pid, signal.SIGKILL))
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = 0  # wait4 has it
        self.code = os.waitstatus_to_exitcode(status)
        self.memory_kb = usage.ru_maxrss


def runs_rows(kelpie, folder):
    Ended(kelpie, folder, [f"{folder}/said\t--version\n"])
    return (folder / "said").exists()


class Attack:
    """The mutants of a kind: each a number, its content and the file it was made of."""

    def __init__(self, kelpie, name, kind, whole, keep, seed):
        self.kelpie, self.name, self.kind, self.whole = kelpie, name, kind, whole
        self.keep, self.seed, self.broken, self.codes = keep, seed, [], {}
        whole_ones = [self.end_of([(-k, f.read_bytes(), f)]) for k, f in enumerate(kind.files, 1)]
        assert any(ones[0][0] == 0 for _, ones in whole_ones), whole_ones[0][1][0][1].decode()
        self.usual_kb = self.most_kb = max(ended.memory_kb for ended, _ in whole_ones)

    def command(self, folder, number, data, original):
        """Writes the mutant; returns its file and the line of its command."""
        names = {"o": folder, "w": self.whole, "n": number, "e": original.suffix,
                 "recover": "--recover" if number % 2 else ""}
        file = Path(self.kind.place.format(**names))
        folder.mkdir()
        file.write_bytes(data)
        if self.name == "vehicle":
            shutil.copy(self.whole / "scenario.toml", folder)
        words = self.kind.command.format(f=file, **names).split()
        return file, "\t".join((f"{folder}/said", *words)) + "\n"

    def end_of(self, mutants):
        """How the process of these mutants ended, and exit code, errors and file's name of each."""
        with tempfile.TemporaryDirectory() as folder:
            folders = [Path(folder, str(number)) for number, _, _ in mutants]
            files, commands = zip(*map(self.command, folders, *zip(*mutants)))
            ended = Ended(self.kelpie, Path(folder), commands)
            ones = []
            for own, file in zip(folders, files):
                said = (own / "said").read_bytes() if (own / "said").exists() else b""
                said, _, code = said.rpartition(b"\n")
                ones.append((ended.code or int(code), said, file.name))
                if file.parent == self.whole:
                    file.unlink()
            return ended, ones

    def mutant(self, number):
        dice = random.Random(f"{self.seed} {self.name} {number}")
        original = dice.choice(self.kind.files)
        data = mutated(original.read_bytes(), dice, self.kind.is_text)
        if self.kind.repair and dice.random() < 0.5:
            data = self.kind.repair(data)
        return number, data, original

    def row(self, numbers):
        mutants = [mutant for mutant in map(self.mutant, numbers) if self.kind.usual(mutant[1])]
        if mutants:
            self.judge(mutants)

    def judge(self, mutants):
        """Counts mutants and what breaks a rule; whether something does."""
        ended, ones = self.end_of(mutants)
        whys = [self.dear(ended) or self.complaint(*one) for one in ones]
        if any(whys) and len(mutants) > 1:
            if any([self.judge([mutant]) for mutant in mutants]) or self.dear(ended):
                return True
            print("only in one process:", *(mutant[0] for mutant in mutants))
        for (number, data, original), (code, said, _), why in zip(mutants, ones, whys):
            self.codes[code] = self.codes.get(code, 0) + 1
            if why:
                kept = self.keep / f"{self.name}_{number}{original.suffix}"
                kept.write_bytes(data)
                self.broken.append(why)
                print(f"{kept}: {why}: {said[-300:].decode(errors='replace').strip()}", flush=True)
        self.most_kb = max(self.most_kb, ended.memory_kb)
        return any(whys)

    def dear(self, ended):
        if -ended.code in (signal.SIGXCPU, signal.SIGKILL):
            return f"more than {MOST_SECONDS} s of processor time or {MOST_WAIT_SECONDS:g} s"
        if ended.memory_kb > self.usual_kb + MOST_MEMORY_KB:
            return f"{ended.memory_kb >> 10} MB, {self.usual_kb >> 10} MB with the whole file"
        return None

    def complaint(self, code, said, file):
        if any(report in said for report in REPORTS):
            return "a report"
        if code not in self.kind.codes:
            return f"exit code {code}"
        if code == 2 and not any(name.encode() in said for name in (file, *self.kind.others)):
            return "exit code 2 without a file's name"
        return None


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kelpie")
    parser.add_argument("--mutants", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=3600.0)
    parser.add_argument("--keep", type=Path, default=Path("mutants"))
    parser.add_argument("--list", action="store_true")
    parser.add_argument("kinds", nargs="*")
    options = parser.parse_intermixed_args()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    options.keep.mkdir(parents=True, exist_ok=True)
    broken = 0
    with tempfile.TemporaryDirectory() as folder:
        kelpie = str(Path(options.kelpie).resolve())
        if not runs_rows(kelpie, Path(folder)):
            parser.error(f"{options.kelpie} has to be the program kelpie_in_a_row, which reads "
                         "commands from its input: cmake --build BUILD --target kelpie_in_a_row")
        kinds = make_kinds(kelpie, Path(folder))
        if options.list:
            print(*kinds, sep="\n")
            return 0
        for name in options.kinds or kinds:
            begin = time.monotonic()
            attack = Attack(kelpie, name, kinds[name], Path(folder), options.keep, options.seed)

            def row(first, attack=attack, begin=begin):
                if time.monotonic() < begin + options.seconds:
                    attack.row(range(first, min(first + ROW, options.mutants)))
            with ThreadPoolExecutor(options.jobs) as pool:
                list(pool.map(row, range(0, options.mutants, ROW)))
            codes = ", ".join(f"{n} ended with {c}" for c, n in sorted(attack.codes.items()))
            print(f"{name}: {sum(attack.codes.values())} mutants in "
                  f"{time.monotonic() - begin:.0f} s: {codes}; at most {attack.most_kb >> 10} MB, "
                  f"{attack.usual_kb >> 10} MB with whole files; {len(attack.broken)} broke a rule",
                  flush=True)
            broken += len(attack.broken)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
