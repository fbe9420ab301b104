# SPDX-License-Identifier: Apache-2.0
"""A replay that runs and shows itself, and a browser that looks."""

import math
import os
import socket
import sqlite3
import struct
import subprocess
import time
import urllib.error
import urllib.request
from contextlib import closing, contextmanager
from pathlib import Path
from random import Random

SOURCE_DIR = Path(__file__).resolve().parents[2]
BUILD_DIR = Path(os.environ.get("KELPIE_BUILD_DIR", SOURCE_DIR / "build/release"))
EVIL = "<script>window.hacked=1</script>"
CONFIG = """
buffer = 60
anchors = 20
terms = "n*|n|; u*|u|; u"
[log]
inputs = ["u", "n"]
targets = ["udot", "{evil}"]
rate = 10
clock = "header"
units = {{u = "m/s", n = "rad/s", udot = "m/s^2"}}
[log.states]
u = "/odom:twist.linear.x"
w = "/odom:twist.linear.y"
[log.commands]
n = "/thruster:twist.linear.x"
[log.derived]
udot = "d(u)"
"{evil}" = "d(w)"
[live]
align = "none"
page = {port}
{more}
"""


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class LiveRun:
    """kelpie live in a folder, on a port of this machine."""

    def __init__(self, folder: Path, recording: Path, speed: str, more: str = "") -> None:
        self.folder = folder
        self.port = free_port()
        self.address = f"http://127.0.0.1:{self.port}/"
        config = folder / "live.toml"
        config.write_text(CONFIG.format(port=self.port, evil=EVIL, more=more))
        self.said = (folder / "said.txt").open("w")
        self.process = subprocess.Popen(
            [BUILD_DIR / "kelpie", "live", "--config", config, "--replay", recording, "--speed",
             speed, "--out", folder / "out"], stdout=self.said, stderr=self.said)

    def wait(self) -> None:
        """Until the page can be opened."""
        end = time.monotonic() + 30
        while True:
            try:
                urllib.request.urlopen(self.address).close()
                return
            except urllib.error.HTTPError:
                return  # it wants a token
            except OSError as error:
                if time.monotonic() > end or self.process.poll() is not None:
                    said = (self.folder / "said.txt").read_text()
                    raise AssertionError(f"no page: {error}\n{said}") from error
                time.sleep(0.05)


@contextmanager
def live_run(folder: Path, recording: Path, speed: str = "4", more: str = ""):
    run = LiveRun(folder, recording, speed, more)
    try:
        run.wait()
        yield run
    finally:
        run.process.terminate()
        run.process.wait(timeout=60)
        run.said.close()


def twist(stamp_ns: int, x: float, y: float) -> bytes:
    """A geometry_msgs/TwistStamped as ROS 2 stores it."""
    seconds, rest = divmod(stamp_ns, 1_000_000_000)
    return struct.pack("<4sIIIBxxx6d", b"\0\1\0\0", seconds, rest, 1, 0, x, y, 0, 0, 0, 0)


def write_mission(file: Path, seconds: float) -> None:
    """A vehicle in two directions under a thruster: 20 Hz of velocities, 11 Hz of its speed, with
    ten seconds of silence after two minutes."""
    random = Random(1)
    begin = 1_700_000_000_000_000_000
    rows = []
    u = w = phase = n = 0.0
    for k in range(int(1000 * seconds)):
        stamp = begin + k * 1_000_000
        if k % 91 == 7:
            phase += random.uniform(0.01, 0.05)
            n = 10 * math.sin(phase) + 3 * math.sin(2.7 * phase)
            rows.append((2, stamp, twist(stamp, n, 0.0)))
        if k % 50 == 3 and not 120_000 < k < 130_000:
            noise = (random.gauss(0, 1e-3), random.gauss(0, 1e-3))
            rows.append((1, stamp, twist(stamp, u + noise[0], w + noise[1])))
        u += 1e-3 * (0.01 * n * abs(n) - 2.0 * u * abs(u) - 0.3 * u)
        w += 1e-3 * (0.02 * n - 0.8 * w)
    with closing(sqlite3.connect(file)) as bag:
        bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT "
                    "NULL, serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
        bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                    "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
        for number, name in ((1, "/odom"), (2, "/thruster")):
            bag.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')",
                        (number, name, "geometry_msgs/msg/TwistStamped"))
        bag.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", rows)
        bag.commit()
