#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle that speaks MAVLink, to try `kelpie live` without one (docs/howto/live.md).

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
    "ATTITUDE": (30, 39, "<I6f"),
    "LOCAL_POSITION_NED": (32, 185, "<I6f"),
    "PARAM_REQUEST_READ": (20, 214, "<hBB16s"),
    "PARAM_VALUE": (22, 220, "<fHH16sB"),
}
NAMES = {number: name for name, (number, _, _) in MESSAGES.items()}
SET_MESSAGE_INTERVAL = 511
PARAMETERS = {"FRAME_CONFIG": 1.0, **{f"SERVO{n}_FUNCTION": 32.0 + n for n in range(1, 7)},
              **{f"SERVO{n}_FUNCTION": 0.0 for n in range(7, 17)},
              **{f"MOT_{n}_DIRECTION": 1.0 for n in range(1, 7)}}
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
    """A BlueROV2 in FRD axes: surge, sway, heave and yaw by six thrusters, roll and pitch upright.

    The factors are those of ArduSub's vectored frame (AP_Motors6DOF.cpp); masses and drags are
    round numbers.
    """

    FORWARD = (-1, -1, 1, 1, 0, 0)
    LATERAL = (1, -1, 1, -1, 0, 0)
    YAW = (1, -1, -1, 1, 0, 0)
    ROLL = (0, 0, 0, 0, 1, -1)

    def __init__(self):
        self.t = 0.0
        self.velocity = [0.0] * 6  # u, v, w, p, q, r
        self.angles = [0.0] * 3  # roll, pitch, yaw
        self.effort = [0.0] * 6  # -1 to 1
        self.pilot = random.Random(1)

    def go(self, dt):
        self.t += dt
        for i in range(6):  # a pilot's hands: towards a new place every few seconds
            wish = (0.4 * math.sin((0.31 + 0.05 * i) * self.t + 1.7 * i)
                    + 0.2 * math.sin(0.83 * self.t + i))
            self.effort[i] += dt * 4.0 * (wish + self.pilot.gauss(0.0, 0.2) - self.effort[i])
            self.effort[i] = max(-1.0, min(1.0, self.effort[i]))
        thrust = [e * abs(e) for e in self.effort]
        push = [sum(f * t for f, t in zip(factors, thrust))
                for factors in (self.FORWARD, self.LATERAL, self.ROLL, self.YAW)]
        force = [1.5 * push[0], 1.2 * push[1], 1.0 * (thrust[4] + thrust[5])]
        moment = [2.0 * push[2] - 6.0 * self.angles[0], 0.4 * force[0] - 6.0 * self.angles[1],
                  4.0 * push[3]]
        linear, quadratic = (0.3, 0.5, 0.6, 1.5, 1.5, 0.8), (1.4, 2.0, 2.5, 1.0, 1.0, 1.5)
        for i, accelerates in enumerate(force + moment):
            v = self.velocity[i]
            self.velocity[i] += dt * (accelerates - linear[i] * v - quadratic[i] * v * abs(v))
        p, q, r = self.velocity[3:]
        roll, pitch, _ = self.angles
        turn = q * math.sin(roll) + r * math.cos(roll)
        for i, rate in enumerate((p + turn * math.tan(pitch), q * math.cos(roll)
                                  - r * math.sin(roll), turn / math.cos(pitch))):
            self.angles[i] += dt * rate
        self.angles[2] = math.remainder(self.angles[2], 2.0 * math.pi)

    def velocity_ned(self):
        u, v, w = self.velocity[:3]
        roll, pitch, yaw = self.angles
        y = v * math.cos(roll) - w * math.sin(roll)
        z = v * math.sin(roll) + w * math.cos(roll)
        x = u * math.cos(pitch) + z * math.sin(pitch)
        return (x * math.cos(yaw) - y * math.sin(yaw), x * math.sin(yaw) + y * math.cos(yaw),
                -u * math.sin(pitch) + z * math.cos(pitch))


def simulate(line, seconds):
    rov = Rov()
    rates = {"HEARTBEAT": 1.0, "ATTITUDE": 4.0, "LOCAL_POSITION_NED": 3.0, "SERVO_OUTPUT_RAW": 2.0}
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
    ms = int(1e3 * rov.t)
    if name == "HEARTBEAT":
        line.send(name, 0, 12, 3, 209, 4, 3)  # a submarine, ArduPilot, armed, active
    elif name == "ATTITUDE":
        line.send(name, ms, *rov.angles, *rov.velocity[3:])
    elif name == "LOCAL_POSITION_NED":
        line.send(name, ms, 0.0, 0.0, 0.0, *rov.velocity_ned())
    else:
        servos = [round(1500 + 400 * effort) for effort in rov.effort]
        line.send(name, 1000 * ms % 2**32, *servos, 0, 0, 0)


def listen(line, rates, due, now, name, values):
    if name == "COMMAND_LONG" and values[7] == SET_MESSAGE_INTERVAL:
        asked = NAMES.get(int(values[0]))
        known = asked in rates and values[1] > 0
        if known:
            rates[asked] = 1e6 / values[1]
            due[asked] = now
            print(f"{asked} comes at {rates[asked]:g} Hz from now on")
        line.send("COMMAND_ACK", SET_MESSAGE_INTERVAL, 0 if known else 3)
    elif name == "PARAM_REQUEST_READ":
        asked = values[3].rstrip(b"\0").decode(errors="replace")
        if asked in PARAMETERS:
            real32 = 9  # MAV_PARAM_TYPE_REAL32
            line.send("PARAM_VALUE", PARAMETERS[asked], len(PARAMETERS), 65535, values[3], real32)
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
