#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Attacks on a running `kelpie live`, over the loopback interface only (docs/howto/live.md).

    python3 scripts/attack_live.py KELPIE web [--count 2000]
    python3 scripts/attack_live.py KELPIE mavlink [--count 100000]
    python3 scripts/attack_live.py KELPIE rubbish [--count 10000]
    python3 scripts/attack_live.py KELPIE replay [--count 20000]

KELPIE is the program. A simulated ROV (examples/bluerov_udp.py) drives meanwhile. web sends hostile
requests to the page, mavlink hostile datagrams to the vehicle's port, before and during the drive,
rubbish datagrams of 6 kB that begin a frame at every byte, 3 MB/s, and replay the vehicle's own
signed frames again, whole and damaged; --count 0 is the drive alone. Ended by itself within four
minutes. Exit code 1 after one of: a signal, an exit code other than 0, ten seconds without an answer or a prediction, more memory than --memory [MB] above the memory before
the attack, a prediction outside of the accelerations seen, fewer samples learned during the attack
than half of those that the vehicle sent (than 95 % during rubbish), at the end R² below 0.5 or more
than 0.1 below that of least squares on the same samples, predictions of the last 150 samples that
explain less than half of the variance of the vehicle's accelerations. The machine may be busy:
samples, not seconds, are counted.
"""

import argparse
import hashlib
import random
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "examples"))
import bluerov_udp as rov  # noqa: E402

PATIENCE_S = 10.0  # until silence is a hang
# Samples learned, however long a machine with other work takes, within WAIT_S.
WARM_UP = 250  # before the attack: a model is in service, and memory has settled
LATER = 150  # after the attack
WHOLE = 750  # in all: R², and what is judged, are of the same part of the drive in every attack
WAIT_S = 75.0
LONGEST_DELAY_S = 3.0  # of a prediction, on the clock of the vehicle
DATAGRAMS_PER_S = 2500
RUBBISH_BYTES, RUBBISH_PER_S = 6_000, 500  # of datagrams
RATE = 10  # rows per second, of mavlink_log.toml
KEY = bytes(range(32))
# Number: (byte of the checksum, fields in the order they are sent in).
MESSAGES = {**rov.MESSAGES, "ODOMETRY": (331, 91, "<Q3f4f3f3f21f21fBB")}
OUTPUTS = ["m1", "m2", "m3", "m4"]
LEARNER = """buffer = 100
anchors = 30
"""
LIVE = """[live]
align = "none"
page = {page}
[live.mavlink]
connection = "udp:{link}"
{key}
"""


def configuration(page, link, key):
    log = (ROOT / "scripts/mavlink_log.toml").read_text()
    log = log.replace("{inputs}", ", ".join(f'"{name}"' for name in OUTPUTS))
    log = log.replace("{commands}", "\n".join(f'{name} = "SERVO_OUTPUT_RAW:servo{k}_raw"'
                                              for k, name in enumerate(OUTPUTS, 1)))
    return LEARNER + log + LIVE.format(page=page, link=link, key=key)


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class SignedLine(rov.Line):
    """Signs every frame, and keeps the last ones."""

    def __init__(self, host, port):
        super().__init__(host, port)
        self.sent = []
        self.signing_time = int((time.time() - 1_420_070_400) * 1e5)  # 10 µs since 2015

    def send_bytes(self, data):
        number = int.from_bytes(data[7:10], "little")
        body = data[1:2] + b"\1" + data[3:-2]
        self.signing_time += 1
        signed = b"\xfd" + body + rov.checksum(body, MESSAGES[rov.NAMES[number]][1])
        signed += b"\0" + self.signing_time.to_bytes(6, "little")
        signed += hashlib.sha256(KEY + signed).digest()[:6]
        self.sent = self.sent[-1000:] + [signed]
        super().send_bytes(signed)


class Vehicle(threading.Thread):
    """The ROV, and a judge of the predictions that come back."""

    def __init__(self, port, signs):
        super().__init__(daemon=True)
        self.line = (SignedLine if signs else rov.Line)("127.0.0.1", port)
        self.ends = threading.Event()
        self.seen = {"udot": [0.0, 0.0], "rdot": [0.0, 0.0]}
        self.body = rov.Rov()
        self.truth = []  # time [s] and accelerations
        self.said = {"udot": [], "rdot": []}  # time [s] and prediction
        self.predictions = 0
        self.beyond = []
        self.heard_at = None
        self.longest_silence_s = 0.0

    def run(self):
        body = self.body
        rates = {"HEARTBEAT": 1.0, "ATTITUDE": 20.0, "LOCAL_POSITION_NED": 20.0,
                 "SERVO_OUTPUT_RAW": 20.0}
        due = dict.fromkeys(rates, 0.0)
        began, step = time.monotonic(), 0.005
        while not self.ends.is_set():
            before = body.velocity[0], body.velocity[5]
            body.go(step)
            after = body.velocity[0], body.velocity[5]
            accelerations = [(now - then) / step for now, then in zip(after, before)]
            self.truth.append((body.t, *accelerations))
            for key, value in zip(self.seen, accelerations):
                low, high = self.seen[key]
                self.seen[key] = [min(low, value), max(high, value)]
            time.sleep(max(0.0, began + body.t - time.monotonic()))
            for name, rate in rates.items():
                if body.t >= due[name]:
                    due[name] += 1.0 / rate
                    rov.say(self.line, body, name)
            for name, values in self.line.heard():
                self.listen(rates, name, values)
            if self.heard_at:
                self.longest_silence_s = max(self.longest_silence_s,
                                             time.monotonic() - self.heard_at)

    def listen(self, rates, name, values):
        if name == "COMMAND_LONG" and values[7] == rov.SET_MESSAGE_INTERVAL:
            known = rov.NAMES.get(int(values[0])) in rates
            self.line.send("COMMAND_ACK", rov.SET_MESSAGE_INTERVAL, 0 if known else 3)
        elif name == "NAMED_VALUE_FLOAT":
            axis = values[2].rstrip(b"\0").decode(errors="replace")
            if axis in self.seen:
                self.predictions += 1
                self.said[axis].append((self.body.t, values[1]))
                self.heard_at = time.monotonic()
                low, high = self.seen[axis]
                if not low - 0.5 * (high - low) <= values[1] <= high + 0.5 * (high - low):
                    self.beyond.append((axis, values[1]))


    def r2_of_predictions(self, since):
        """Of each axis, R² of what was said since then [s], beside the accelerations of the
        vehicle so much earlier as fits best: a prediction names no time."""
        step = self.truth[0][0]
        best = {}
        for column, (axis, pairs) in enumerate(self.said.items(), 1):
            late = [(round(t / step) - 1, value) for t, value in pairs if t > since]
            best[axis] = max((r_squared([(self.truth[max(0, at - delay)][column], value)
                                         for at, value in late])
                              for delay in range(0, round(LONGEST_DELAY_S / step), 10)),
                             default=float("nan"))
        return best


def r_squared(pairs):
    if len(pairs) < 20:
        return float("nan")
    mean = sum(truth for truth, _ in pairs) / len(pairs)
    return 1.0 - (sum((truth - said) ** 2 for truth, said in pairs)
                  / sum((truth - mean) ** 2 for truth, _ in pairs))


class Run:
    """kelpie live in a folder of its own."""

    def __init__(self, kelpie, folder, signs):
        self.page, self.link = free_port(socket.SOCK_STREAM), free_port(socket.SOCK_DGRAM)
        (folder / "key").write_text(KEY.hex())
        key = f'key = "{folder / "key"}"' if signs else ""
        (folder / "live.toml").write_text(configuration(self.page, self.link, key))
        self.said = (folder / "said.txt").open("w+")
        self.process = subprocess.Popen(
            [kelpie, "live", "--config", folder / "live.toml", "--out", folder / "out"],
            stdout=subprocess.DEVNULL, stderr=self.said)
        self.slowest_s = 0.0
        end = time.monotonic() + 30
        while time.monotonic() < end and self.metrics() is None:
            time.sleep(0.1)

    def metrics(self):
        """The page's metrics, or null; how long an honest request takes is kept."""
        began = time.monotonic()
        try:
            address = f"http://127.0.0.1:{self.page}/metrics"
            with urllib.request.urlopen(address, timeout=PATIENCE_S) as answer:
                text = answer.read().decode()
        except (OSError, ValueError):
            return None
        self.slowest_s = max(self.slowest_s, time.monotonic() - began)
        return {key: float(value) for key, value in re.findall(r"^(\w\S*) (\S+)$", text, re.M)}

    def learned(self):
        return (self.metrics() or {}).get("kelpie_samples_learned", 0.0)

    def wait_until_learned(self, samples):
        end = time.monotonic() + WAIT_S
        while self.learned() < samples and time.monotonic() < end and self.process.poll() is None:
            time.sleep(0.5)

    def megabytes(self, key="VmHWM"):
        try:
            status = Path(f"/proc/{self.process.pid}/status").read_text()
        except FileNotFoundError:
            return 0.0
        found = re.search(key + r":\s+(\d+) kB", status)
        return int(found[1]) * 1024 / 1e6 if found else 0.0

    def end(self):
        """The exit code, negative: a signal. None: it doesn't end."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return None


def requests_of(chance):
    """Names and bytes of hostile requests, without end."""
    head = b" HTTP/1.1\r\nHost: localhost\r\n"
    bomb = zlib.compress(bytes(20_000_000), 9)

    def body(coding, data):
        return (b"POST /save" + head + b"Content-Encoding: " + coding +
                b"\r\nContent-Length: %d\r\n\r\n" % len(data) + data)

    kinds = {
        "ranges": lambda: b"GET /" + head + b"Range: bytes=0-" +
            b",0-" * chance.randrange(1, 3000) + b"\r\n\r\n",
        "brotli": lambda: body(b"br", bytes.fromhex("cf ffff7ff824 00e2b1") + chance.randbytes(6000)),
        "deflate": lambda: body(chance.choice([b"gzip", b"deflate", b"br, gzip"]), bomb),
        "long body": lambda: b"POST /save" + head + b"Content-Length: 99999999999\r\n\r\n" +
            chance.randbytes(20_000),
        "chunks": lambda: b"POST /save" + head + b"Transfer-Encoding: chunked\r\n\r\n" +
            b"ffffffffffffffff\r\n" + chance.randbytes(9_000),
        "long header": lambda: b"GET /" + head + b"A: " + b"x" * chance.randrange(100_000),
        "many headers": lambda: b"GET /" + head + b"A: b\r\n" * chance.randrange(5_000) + b"\r\n",
        "long path": lambda: b"GET /" + b"%41" * chance.randrange(20_000) + head + b"\r\n",
        "arguments": lambda: b"GET /?" + b"token=&" * chance.randrange(3_000) + head + b"\r\n",
        "noise": lambda: chance.randbytes(chance.randrange(1, 5_000)),
        "other protocol": lambda: chance.choice(
            [b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
             b"GET /\r\n", b"GET / HTTP/9.9\r\n\r\n", b"CONNECT a:1" + head + b"\r\n",
             b"POST /save HTTP/1.1\r\nHost: evil.example\r\n\r\n", b"OPTIONS *" + head + b"\r\n"]),
        "many at once": lambda: (b"GET /metrics" + head + b"\r\n") * chance.randrange(1, 500),
        "multipart": lambda: b"POST /save" + head + b"Content-Type: multipart/form-data; boundary=" +
            b"a" * 3000 + b"\r\nContent-Length: 4000\r\n\r\n" + b"--a\r\n" * 800,
        "events": lambda: b"GET /events" + head + b"\r\n",
        "page": lambda: b"GET /" + head + b"\r\n",
        "metrics": lambda: b"HEAD /metrics" + head + b"\r\n",
    }
    while True:
        name = chance.choice(list(kinds))
        data = kinds[name]()
        if chance.random() < 0.2:  # a mutant of it
            data = bytearray(data)
            for _ in range(chance.randrange(1, 20)):
                data[chance.randrange(min(len(data), 400))] = chance.randrange(256)
        yield name, bytes(data)


def attack_web(run, _vehicle, count, chance):
    """Some connections read their answer, some leave at once, some stay and say no more."""
    staying = []
    requests = requests_of(chance)
    for number in range(count):
        if run.process.poll() is not None:
            return
        _, data = next(requests)
        one = socket.socket()
        one.settimeout(0.2)
        try:
            one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, chance.choice([2048, 65536]))
            one.connect(("127.0.0.1", run.page))
            stays = chance.random()
            one.sendall(data if stays > 0.3 else data[:chance.randrange(1, len(data) + 1)])
            if stays > 0.7:
                one.recv(1 << 16)
        except OSError:
            pass
        if stays < 0.5:
            staying.append(one)
        else:
            one.close()
        if len(staying) > 200:
            staying.pop(chance.randrange(100)).close()
        if number % 50 == 0:
            check(run.metrics() is not None, f"no answer after {number} requests")


def frame(system, component, sequence, name, values, version=2):
    number, extra, layout = MESSAGES[name]
    payload = struct.pack(layout, *values)
    if version == 1:
        body = struct.pack("<5B", len(payload), sequence % 256, system, component, number) + payload
        return b"\xfe" + body + rov.checksum(body, extra)
    payload = payload.rstrip(b"\0") or b"\0"
    body = struct.pack("<6B", len(payload), 0, 0, sequence % 256, system, component)
    body += number.to_bytes(3, "little") + payload
    return b"\xfd" + body + rov.checksum(body, extra)


def datagrams(chance):
    """Hostile datagrams, without end."""
    beat = (0, 12, 3, 0, 4, 3)

    def wild():
        return chance.choice([1e6, -1e6, 1e30, float("nan"), float("inf"), 0.5])

    def odometry():
        return (chance.randrange(2**63), *[0.0] * 3, 1.0, *[0.0] * 3, wild(), 0.0, 0.0, 0.0, 0.0,
                wild(), *[0.0] * 42, 20, 12)

    def sender():
        return chance.randrange(1, 256), chance.randrange(1, 256)

    sequence = 0
    while True:
        sequence += 1
        some = [frame(*sender(), sequence, "HEARTBEAT", beat),
                frame(1, 1, sequence, "HEARTBEAT", beat),
                frame(1, 1, sequence, "ODOMETRY", odometry()),
                frame(*sender(), sequence, "ODOMETRY", odometry()),
                frame(1, 1, sequence, "SERVO_OUTPUT_RAW", (0, *[65535] * 8, 0)),
                frame(1, 1, sequence, "COMMAND_ACK", (rov.SET_MESSAGE_INTERVAL, 3)),
                frame(1, 1, sequence, "HEARTBEAT", beat, version=1),
                frame(*sender(), sequence, "SERVO_OUTPUT_RAW", (0, *[65535] * 8, 0), version=1),
                frame(1, 1, sequence, "PARAM_VALUE", (1.0, 9, 9, b"MOT_1_DIRECTION", 9)),
                frame(*sender(), sequence, "PARAM_VALUE", (wild(), 65535, sequence % 65536,
                                                           chance.randbytes(16), 9))]
        yield from some
        mutant = bytearray(chance.choice(some))
        for _ in range(chance.randrange(1, 6)):
            mutant[chance.randrange(len(mutant))] = chance.randrange(256)
        yield bytes(mutant)
        yield b"\xfd\xff" + chance.randbytes(chance.randrange(0, 300))  # a begin without an end
        yield chance.randbytes(chance.randrange(0, 1_400))
        yield b"".join(some) * chance.randrange(1, 10)
        for _ in range(4):
            yield frame(*sender(), sequence, "HEARTBEAT", beat)


def rubbish(chance):
    """Frames that begin at every byte, every sixth, every tenth; and noise of such begins."""
    patterns = [b"\xfd", b"\xfe", bytes.fromhex("feff00000083"), bytes.fromhex("fdff" + "00" * 8)]
    noise = bytes(chance.choice(b"\xfd\xfe") for _ in range(RUBBISH_BYTES))
    while True:
        for pattern in patterns:
            yield (pattern * RUBBISH_BYTES)[:RUBBISH_BYTES]
        yield noise


def repeats(sent, chance):
    """What the vehicle has signed, again: as it was, damaged, or within a frame of version 1."""
    while True:
        data = bytearray(chance.choice(sent()))
        if chance.random() < 0.5:
            data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        yield bytes(data) if chance.random() < 0.9 else b"\xfe" + bytes(data)


def send_datagrams(run, source, count, sockets, chance, per_s=DATAGRAMS_PER_S):
    began = time.monotonic()
    for number in range(count):
        if run.process.poll() is not None:
            return
        try:
            chance.choice(sockets).sendto(next(source), ("127.0.0.1", run.link))
        except ConnectionError:
            pass
        if number % (per_s // 5) == 0:
            time.sleep(max(0.0, began + number / per_s - time.monotonic()))
        if number % (4 * per_s) == 0:
            check(run.metrics() is not None, f"no answer after {number} datagrams")


def attack_mavlink(run, _vehicle, count, chance):
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(20)]
    send_datagrams(run, datagrams(chance), count, sockets, chance)


def attack_rubbish(run, _vehicle, count, chance):
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(3)]
    send_datagrams(run, rubbish(chance), count, sockets, chance, RUBBISH_PER_S)


def attack_replay(run, vehicle, count, chance):
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(3)]
    send_datagrams(run, repeats(lambda: vehicle.line.sent, chance), count, sockets, chance)


# Of each attack: what happens, how often, and the share of the rows that is learned meanwhile.
ATTACKS = {"web": (attack_web, 2_000, 0.5), "mavlink": (attack_mavlink, 100_000, 0.5),
           "rubbish": (attack_rubbish, 10_000, 0.95), "replay": (attack_replay, 20_000, 0.5)}


def flood_beforehand(run, count, chance):
    """Other autopilots, before there is a vehicle."""
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM)]
    beats = (frame(1 + number // 40, 2 + number % 40, number, "HEARTBEAT", (0, 12, 3, 0, 4, 3))
             for number in range(count))
    send_datagrams(run, beats, count, sockets, chance)


FAULTS = []


def check(holds, fault):
    if not holds and fault not in FAULTS:
        FAULTS.append(fault)
        print("WRONG:", fault, flush=True)


def text(values):
    return ", ".join(f"{axis} {value:.3f}" for axis, value in values.items())


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("kelpie")
    parser.add_argument("attack", choices=list(ATTACKS))
    parser.add_argument("--count", type=int, help="requests or datagrams")
    parser.add_argument("--memory", type=float, default=300.0, help="[MB], %(default)s")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    attack, usual, share = ATTACKS[options.attack]
    count = usual if options.count is None else options.count
    signs = attack is attack_replay
    with tempfile.TemporaryDirectory(prefix="kelpie_attack_") as folder:
        run = Run(options.kelpie, Path(folder), signs)
        if attack is attack_mavlink:
            flood_beforehand(run, min(10_000, count // 4), chance)
            count -= min(10_000, count // 4)
        vehicle = Vehicle(run.link, signs)
        vehicle.start()
        run.wait_until_learned(WARM_UP)
        before, memory = run.learned(), run.megabytes("VmRSS")
        began, drove_s = time.monotonic(), vehicle.body.t
        attack(run, vehicle, count, chance)
        passed_s, ended_s = time.monotonic() - began, vehicle.body.t
        learned = run.learned()
        # A younger model says less, whether it was attacked or not.
        run.wait_until_learned(WHOLE - LATER)
        judged_s = vehicle.body.t
        run.wait_until_learned(max(learned + LATER, WHOLE))
        after, most = run.metrics() or {}, run.megabytes()
        vehicle.ends.set()
        vehicle.join()
        code = run.end()
        run.said.seek(0)
        said = run.said.read()
    meanwhile, later = learned - before, after.get("kelpie_samples_learned", 0) - learned
    said_r2 = vehicle.r2_of_predictions(judged_s)
    r2, squares_r2 = ({axis: after.get(f'kelpie_axis_r2{{axis="{axis}",predictor="{by}"}}',
                                       float("nan")) for axis in ("udot", "rdot")}
                      for by in ("model", "least_squares"))
    check(code == 0, f"exit code {code}: {said[-3000:]}")
    check(most - memory <= options.memory, "memory")
    check(vehicle.predictions > 0 and vehicle.longest_silence_s < PATIENCE_S, "predictions ceased")
    check(not vehicle.beyond, f"predictions beyond what was seen: {vehicle.beyond[:5]}")
    check(meanwhile > share * RATE * (ended_s - drove_s) - RATE,
          f"{meanwhile:.0f} samples learned of {ended_s - drove_s:.0f} s of driving")
    check(later >= LATER, f"{later:.0f} samples learned after the attack")
    check(all(r2[axis] > max(0.5, squares_r2[axis] - 0.1) for axis in r2),
          f"R², where least squares has {text(squares_r2)}")
    check(all(value > 0.5 for value in said_r2.values()), "predictions beside the truth")
    print(f"{count} in {passed_s:.0f} s; memory {memory:.0f} MB before, {most:.0f} MB at most; "
          f"slowest honest answer {run.slowest_s:.2f} s; {meanwhile:.0f} samples learned of "
          f"{ended_s - drove_s:.0f} s of driving, {later:.0f} later; {vehicle.predictions} "
          f"predictions, longest silence {vehicle.longest_silence_s:.2f} s; R² {text(r2)} (least "
          f"squares {text(squares_r2)}); of what was said later, beside the truth, "
          f"{text(said_r2)}; exit code {code}")
    sys.exit(1 if FAULTS else 0)


if __name__ == "__main__":
    main()
