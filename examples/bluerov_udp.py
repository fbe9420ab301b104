#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle that speaks MAVLink, to try `kelpie live` without one (docs/live.md).

    python3 examples/bluerov_udp.py                    # a simulated ROV at 127.0.0.1:14550
    python3 examples/bluerov_udp.py --tlog dive.tlog   # a recorded dive, as it was received

The simulated ROV behaves as ArduSub does: SERVO_OUTPUT_RAW comes at 2 Hz until a faster rate is
asked for by SET_MESSAGE_INTERVAL. What kelpie sends back is printed. Needs nothing but Python.
"""

import argparse
import math
import random
import socket
import struct
import time

# Number: (byte of the checksum, fields in the order they are sent in), as MAVLink defines them.
MESSAGES = {
    "HEARTBEAT": (0, 50, "<IBBBBB"),
    "COMMAND_LONG": (76, 152, "<7fHBBB"),
    "COMMAND_ACK": (77, 143, "<HB"),
    "NAMED_VALUE_FLOAT": (251, 170, "<If10s"),
    "STATUSTEXT": (253, 83, "<B50sHB"),
    "SERVO_OUTPUT_RAW": (36, 222, "<I8HB"),
    "ODOMETRY": (331, 91, "<Q3f4f3f3f21f21fBB"),
}
NAMES = {number: name for name, (number, _, _) in MESSAGES.items()}
SET_MESSAGE_INTERVAL = 511
HEALTH = ("msgs_lost", "rows_lost", "learned", "frozen", "delay_ms")  # beside predictions


def checksum(data, extra):
    crc = 0xFFFF
    for byte in data + bytes([extra]):
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return struct.pack("<H", crc)


class Line:
    """Frames of MAVLink 2 over UDP."""

    def __init__(self, host, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setblocking(False)
        self.to = (host, port)
        self.sequence = 0

    def send(self, name, *values):
        number, extra, layout = MESSAGES[name]
        payload = struct.pack(layout, *values).rstrip(b"\0") or b"\0"
        head = struct.pack("<6B", len(payload), 0, 0, self.sequence, 1, 1)
        body = head + number.to_bytes(3, "little") + payload
        self.sequence = (self.sequence + 1) % 256
        self.send_bytes(b"\xfd" + body + checksum(body, extra))

    def send_bytes(self, data):
        try:
            self.socket.sendto(data, self.to)
        except ConnectionError:
            pass  # nobody listens yet

    def heard(self):
        """Name and values of what has come."""
        while True:
            try:
                data = self.socket.recv(65536)
            except (BlockingIOError, ConnectionError):
                return
            name = NAMES.get(int.from_bytes(data[7:10], "little"))
            if data[:1] == b"\xfd" and name:
                layout = MESSAGES[name][2]
                size = struct.calcsize(layout)
                yield name, struct.unpack(layout, data[10:10 + data[1]].ljust(size, b"\0")[:size])


class Rov:
    """Surge and yaw, by one thruster on either side."""

    def __init__(self):
        self.u = self.r = self.t = 0.0
        self.n = [0.0, 0.0]
        self.pilot = random.Random(1)

    def go(self, dt):
        self.t += dt
        for side in (0, 1):  # a pilot's hands: towards a new place every few seconds
            wish = 8.0 * math.sin(0.31 * self.t + 1.7 * side) + 4.0 * math.sin(0.83 * self.t + side)
            self.n[side] += dt * 4.0 * (wish + self.pilot.gauss(0.0, 3.0) - self.n[side])
        thrust = [n * abs(n) for n in self.n]
        self.u += dt * (0.006 * sum(thrust) - 1.4 * self.u * abs(self.u) - 0.3 * self.u)
        self.r += dt * (0.02 * (thrust[0] - thrust[1]) - 1.1 * self.r * abs(self.r) - 0.5 * self.r)


def simulate(line, seconds):
    rov = Rov()
    rates = {"HEARTBEAT": 1.0, "ODOMETRY": 4.0, "SERVO_OUTPUT_RAW": 2.0}
    due = dict.fromkeys(rates, 0.0)
    step = 0.005
    began = time.monotonic()
    while rov.t < seconds:
        rov.go(step)
        time.sleep(max(0.0, began + rov.t - time.monotonic()))
        for name, rate in rates.items():
            if rov.t >= due[name]:
                due[name] += 1.0 / rate
                say(line, rov, name)
        for name, values in line.heard():
            listen(line, rates, due, rov.t, name, values)


def say(line, rov, name):
    usec = int(1e6 * rov.t)
    if name == "HEARTBEAT":
        line.send(name, 0, 12, 3, 0, 4, 3)  # a submarine, ArduPilot, active
    elif name == "ODOMETRY":
        line.send(name, usec, *[0.0] * 3, 1.0, *[0.0] * 3, rov.u, 0.0, 0.0, 0.0, 0.0, rov.r,
                  *[0.0] * 42, 20, 12)
    else:
        servos = [round(1500 + 30 * n) for n in rov.n]
        line.send(name, usec % 2**32, *servos, *[1500] * 6, 0)


def listen(line, rates, due, now, name, values):
    if name == "COMMAND_LONG" and values[7] == SET_MESSAGE_INTERVAL:
        asked = NAMES.get(int(values[0]))
        known = asked in rates and values[1] > 0
        if known:
            rates[asked] = 1e6 / values[1]
            due[asked] = now
            print(f"{asked} comes at {rates[asked]:g} Hz from now on")
        line.send("COMMAND_ACK", SET_MESSAGE_INTERVAL, 0 if known else 3)
    elif name == "NAMED_VALUE_FLOAT":
        text = values[2].rstrip(b"\0").decode(errors="replace")
        if text not in HEALTH:
            print(f"  {text} {values[1]:+.4f}", end="\r", flush=True)
    elif name == "STATUSTEXT":
        print(values[1].rstrip(b"\0").decode(errors="replace"))


def play(line, path, speed):
    """A .tlog: before each frame 8 bytes, the time at which it was received in µs."""
    with open(path, "rb") as file:
        log = file.read()
    at, began, first = 0, time.monotonic(), None
    while at + 10 <= len(log):
        stamp = int.from_bytes(log[at:at + 8], "big") / 1e6
        first = first or stamp
        second = log[at + 8] == 0xFD
        size = log[at + 9] + (12 + (13 if log[at + 10] & 1 else 0) if second else 8)
        time.sleep(max(0.0, began + (stamp - first) / speed - time.monotonic()))
        line.send_bytes(log[at + 8:at + 8 + size])
        at += 8 + size
        for name, values in line.heard():
            if name == "STATUSTEXT":
                print(values[1].rstrip(b"\0").decode(errors="replace"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--to", default="127.0.0.1:14550", help="host:port (%(default)s)")
    parser.add_argument("--seconds", type=float, default=math.inf, help="of the simulation")
    parser.add_argument("--tlog", help="a recorded dive in place of the simulation")
    parser.add_argument("--speed", type=float, default=1.0, help="of the recorded dive")
    options = parser.parse_args()
    host, port = options.to.rsplit(":", 1)
    line = Line(host, int(port))
    try:
        if options.tlog:
            play(line, options.tlog, options.speed)
        else:
            simulate(line, options.seconds)
    except KeyboardInterrupt:
        print()


if __name__ == "__main__":
    main()
