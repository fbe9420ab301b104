#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Attacks on `kelpie live` over DDS, on this machine's loopback alone (docs/howto/live.md).

    python3 scripts/attack_dds.py BUILD [--only NAME] [--most-mb 300] [--seed 1]

BUILD holds kelpie and peer_cyclone, as in build/release. Each attack starts `kelpie live` beside a
vehicle that is learned, does harm, lets the vehicle swim on, and ends kelpie by SIGTERM. Checked are
the exit code, the end within 10 s, the peak of memory (at most --most-mb above the peak of a run
without an attack; sanitizers need more), learning after the attack, and every prediction served:
none beyond twice the range of the accelerations seen. Takes some three minutes. Exit code 1 where
something isn't so.
"""

import argparse
import fcntl
import queue
import random
import re
import resource
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

CONFIG = """buffer = 60
anchors = 20
[log]
inputs = ["u", "v", "r", "x", "y", "n"]
targets = ["udot", "vdot", "rdot"]
rate = 10
clock = "header"
[log.states]
u = "{odom}:twist.twist.linear.x"
v = "/odom:twist.twist.linear.y"
r = "/odom:twist.twist.angular.z"
[log.commands]
x = "/thrust:wrench.force.x"
y = "/thrust:wrench.force.y"
n = "/thrust:wrench.torque.z"
[log.derived]
udot = "d(u)"
vdot = "d(v)"
rdot = "d(r)"
[live]
out = "out"
align = "none"
checkpoint = 1
record = "rec"
[live.dds]
domain = {domain}
loopback = true
"""
ODOMETRY = "nav_msgs/msg/Odometry"
TEXT = "std_msgs/msg/String"
SEEN = 1.5  # [m/s², rad/s²] largest acceleration of the peers' vehicle
PATIENCE_S = 10.0  # for an end


def free_domain():
    """A domain that no test of this machine is in, and the lock that keeps it."""
    for domain in range(20, 100):
        file = open(Path(tempfile.gettempdir()) / f"kelpie-dds-domain-{domain}", "w")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return domain, file
        except OSError:
            file.close()
    sys.exit("no DDS domain is free")


class Peer:
    """A program that does what its lines say (tests/live/dds/peer_commands.hpp)."""

    def __init__(self, build, domain):
        self.process = subprocess.Popen([build / "peer_cyclone", str(domain)], text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL)
        self.heard = []
        self.answers = queue.Queue()
        self.reader = threading.Thread(target=self.read)
        self.reader.start()

    def read(self):
        for line in self.process.stdout:
            if line.startswith("got "):
                self.heard.append(line)
            else:
                self.answers.put(line.split()[0])
        self.answers.put("")

    def say(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def order(self, line):
        self.say(line)
        while answer := self.answers.get():
            if answer == line.split()[0]:
                return
        raise RuntimeError(f"the peer ended at: {line[:60]}")

    def end(self):
        self.process.stdin.close()
        self.process.wait()
        self.reader.join()


class Live:
    """`kelpie live` in a folder of its own, with its text and peak of memory."""

    def __init__(self, build, folder):
        self.process = subprocess.Popen([build / "kelpie", "live", "--config", "x.toml"],
                                        cwd=folder, text=True, restore_signals=False,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.text = ""
        self.peak_mb = 0.0
        self.reader = threading.Thread(target=self.read)
        self.reader.start()
        self.watcher = threading.Thread(target=self.watch)
        self.watcher.start()

    def read(self):
        for line in self.process.stderr:
            self.text += line

    def watch(self):
        while self.process.poll() is None:
            try:
                status = Path(f"/proc/{self.process.pid}/status").read_text()
                self.peak_mb = int(re.search(r"VmHWM:\s+(\d+)", status)[1]) * 1024 / 1e6
            except (OSError, TypeError):
                pass
            time.sleep(0.02)

    def says(self, text, times=1, within_s=30.0):
        end = time.monotonic() + within_s
        while self.text.count(text) < times:
            if time.monotonic() > end or self.process.poll() is not None:
                return False
            time.sleep(0.01)
        return True

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        try:
            code = self.process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = None
        self.watcher.join()
        self.reader.join()
        return code


class Room:
    """The network of an attack: kelpie, the vehicle, an attacker, and a subscriber."""

    def __init__(self, build, seed):
        self.build = build
        self.random = random.Random(seed)
        self.domain, self.lock = free_domain()
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)
        (self.path / "x.toml").write_text(CONFIG.format(odom="/odom", domain=self.domain))
        self.live = Live(build, self.path)
        self.vehicle = Peer(build, self.domain)
        self.vehicle.order(f"publish /odom {ODOMETRY} reliable")
        self.vehicle.order("publish /thrust geometry_msgs/msg/WrenchStamped reliable")
        self.peers = [self.vehicle]
        self.faults = []
        if not self.swim_until("a model is in service"):
            self.faults.append("no model before the attack")
        self.subscriber = self.peer()
        self.subscriber.order("subscribe /kelpie/prediction "
                              "geometry_msgs/msg/AccelWithCovarianceStamped reliable")

    def peer(self):
        self.peers.append(Peer(self.build, self.domain))
        return self.peers[-1]

    def swim_until(self, text):
        for _ in range(60):
            self.vehicle.order("mission 200 1000")
            if text in self.live.text:
                return True
        return self.live.says(text)

    def learned(self):
        """Samples learned, as a command makes kelpie say."""
        before = self.live.text.count("saved, after")
        commander = self.peer()
        commander.order(f"publish /kelpie/command {TEXT} reliable")
        for _ in range(300):  # rows come first, faster than sanitizers learn
            commander.order("text save")
            if self.live.says("saved, after", before + 1, 0.6):
                return int(re.findall(r"saved, after (\d+)", self.live.text)[-1])
        self.faults.append("no answer to a command")
        return 0

    def served(self):
        """The accelerations of all predictions that came."""
        for line in self.subscriber.heard:
            cdr = bytes.fromhex(line[4:])
            frame = struct.unpack_from("<I", cdr, 12)[0]
            at = 4 + (12 + frame + 7) // 8 * 8  # doubles are aligned behind the encapsulation
            yield from struct.unpack_from("<6d", cdr, at)

    def close(self):
        code = self.live.end()
        if code != 0:
            self.faults.append("no end within 10 s" if code is None else f"exit code {code}")
            self.faults += self.live.text.splitlines()[-5:]
        for peer in self.peers:
            peer.end()
        worst = max((abs(value) for value in self.served()), default=0.0)
        if not worst <= 2.0 * SEEN:
            self.faults.append(f"a prediction of {worst:g} was served")
        self.lock.close()
        self.folder.cleanup()
        return worst


def calm(room):
    room.vehicle.order("mission 500 1000")


def many_topics(room):
    """Of many types, both qualities, and the same names again with others."""
    others = [room.peer(), room.peer()]
    for k in range(5000):
        kind = [TEXT, ODOMETRY, f"other_msgs/msg/Type{k % 500}"][k % 3]
        quality = ["reliable", "best_effort"][k % 2]
        others[k // 2500].order(f"publish /other/topic_{k % 3500} {kind} {quality}")
    room.vehicle.order("mission 2000 1000")


def types_that_change(room):
    """On the vehicle's topic, short of and beyond what a name may have; each is said, a few times."""
    for k in range(10):
        other = room.peer()
        for n in range(30):
            name = "T" * [1, 30, 200, 20_000][n % 4]
            other.order(f"publish /odom other_msgs/msg/{name}{k}x{n} "
                        f"{['reliable', 'best_effort'][n % 2]}")
        room.vehicle.order("mission 100 1000")
        room.peers.remove(other)
        other.end()
    if len(room.live.text) > 100_000 or max(map(len, room.live.text.splitlines())) > 1000:
        room.faults.append("events without end")


def topics_that_come_and_go(room):
    for _ in range(10):
        other = room.peer()
        for k in range(300):
            other.order(f"publish /other/topic_{k} {TEXT} best_effort")
        room.vehicle.order("mission 100 1000")
        room.peers.remove(other)
        other.end()


def long_commands(room):
    other = room.peer()
    other.order(f"publish /kelpie/command {TEXT} reliable")
    other.order("stream 2000 1100 900000")
    if not room.live.says("a command of more than"):
        room.faults.append("no word about a command that is too long")


def many_commands(room):
    other = room.peer()
    other.order(f"publish /kelpie/command {TEXT} reliable")
    for k in range(6000):
        other.order("text " + room.random.choice(["save", "freeze", "resume", "nonsense", "x" * 200]))
    other.order("text resume")
    if room.live.text.count("saved, after") > 200:
        room.faults.append("a checkpoint for each of many equal commands")


def commands_at_the_end(room):
    """The flood goes on while kelpie ends."""
    other = room.peer()
    other.order(f"publish /kelpie/command {TEXT} reliable")
    while "saved, after" not in room.live.text:
        other.order("text save")
    for _ in range(3000):
        other.say("text save")


def long_messages(room):
    other = room.peer()
    other.order(f"publish /odom {ODOMETRY} reliable")
    other.order("stream 5000 1500 900000")


def garbage(room):
    other = room.peer()
    other.order(f"publish /odom {ODOMETRY} reliable")
    for _ in range(3000):
        noise = room.random.randbytes(room.random.randrange(4, 900))
        other.order("send " + (b"\0\1\0\0" + noise).hex())


def huge_values(room):
    other = room.peer()
    other.order(f"publish /odom {ODOMETRY} reliable")
    for velocity in ["1e300", "-1e300", "1e9", "nan", "inf", "-inf", "1e-320"] * 20:
        other.order(f"odometry 1700000100 {velocity}")


def clocks(room):
    other = room.peer()
    other.order(f"publish /odom {ODOMETRY} reliable")
    year = 365 * 86_400
    for second in [1_731_536_000] * 3 + [0, 2_147_483_647, -2_147_483_648, 1_700_000_000,
                                         1_700_000_000 - year, 1_700_000_000 + year] * 2:
        other.order(f"odometry {second} 0.1")
        room.vehicle.order("mission 100 1000")


def full_disk(room):
    """No file grows beyond 1 kB for a while."""
    pid = room.live.process.pid
    limits = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (1024, limits[1]))
    failing = ["no checkpoint can be written", "nothing can be recorded"]
    back = ["checkpoints are written again", "recording goes on"]
    for texts in (failing, back):
        for text in texts:
            if not room.swim_until(text):
                room.faults.append(f"no word: {text}")
        resource.prlimit(pid, resource.RLIMIT_FSIZE, limits)


def datagrams(room):
    """RTPS headers with noise, to kelpie's and the peers' ports."""
    line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    for k in range(20_000):
        port = 7400 + 250 * room.domain + 10 + room.random.randrange(8)
        noise = room.random.randbytes(room.random.randrange(0, 1400))
        head = b"RTPS\x02\x01" if k % 3 else b""
        line.sendto(head + noise, ("127.0.0.1", port))
    line.close()
    if len(room.live.text) > 100_000:
        room.faults.append("a line of text for each packet")


ATTACKS = [calm, many_topics, types_that_change, topics_that_come_and_go, long_commands, many_commands, long_messages,
           garbage, huge_values, clocks, full_disk, datagrams, commands_at_the_end]


def wrong_names(build):
    """Names of topics that are none end with code 2, file and line."""
    faults = []
    domain, lock = free_domain()
    with tempfile.TemporaryDirectory() as folder:
        for name in ["/odom/", "/a//b", "/é", "/1a", "/", "", ":", "/" + "a" * 100_000 + "/"]:
            (Path(folder) / "x.toml").write_text(CONFIG.format(odom=name, domain=domain))
            run = subprocess.run([build / "kelpie", "live", "--config", "x.toml"], cwd=folder,
                                 capture_output=True, text=True, timeout=PATIENCE_S)
            if run.returncode != 2 or "x.toml:9: log.states.u" not in run.stderr:
                faults.append(f"{name[:20]!r}: {run.returncode}, {run.stderr[:200]}")
    lock.close()
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--only")
    parser.add_argument("--most-mb", type=float, default=300.0)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    options.build = options.build.resolve()
    faults = wrong_names(options.build)
    print("wrong_names:", "; ".join(faults) or "well", flush=True)
    usual_mb = 0.0
    for attack in ATTACKS:
        if options.only not in (None, attack.__name__) and attack is not calm:
            continue
        begin = time.monotonic()
        room = Room(options.build, options.seed)
        attack(room)
        if attack is not commands_at_the_end:
            before = room.learned()
            room.vehicle.order("mission 3000 1000")
            if room.learned() < before + 100:
                room.faults.append("nothing is learned after the attack")
        worst = room.close()
        usual_mb = usual_mb or room.live.peak_mb
        if room.live.peak_mb > usual_mb + options.most_mb:
            room.faults.append("too much memory")
        faults += room.faults
        print(f"{attack.__name__}: {'; '.join(room.faults) or 'well'}; "
              f"{room.live.peak_mb:.0f} MB, largest prediction {worst:.2f}, "
              f"{time.monotonic() - begin:.0f} s", flush=True)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
