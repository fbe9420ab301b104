#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Simulated vehicles drawn at random, learned without an option: a look for vehicles that fail.

    lab/random_vehicles.py OUT --base 77000 --vehicles 24 [--kelpie build/release/kelpie] [--change]

Vehicle k of a base is drawn with the seed base + k: surge, sway and yaw with couplings; two to six
thrusters (linear, quadratic or with a dead band, weaker astern, with lag and delay) or a propeller
with a rudder; time constants of 0.4 to 20 s; 1 to 100 Hz; waves, currents and noise or none;
commands as -1 to 1, pulses, percent or rpm; random steps, sines, or a controller that follows
references; accelerations of an IMU or as differences of velocities. Every fifth of 25 blocks is
held out. Prints R² at the end beside the least squares of result.json, and writes
OUT/vehicles.json. With --change a thruster fails, a load comes or drag grows after 60 % of the
drive, every third of the blocks after the change is held out, and the other figure is of kelpie
begun at the change. Wants numpy.
"""
import argparse
import json
import subprocess
from pathlib import Path

import numpy as np

NAMES = ["u", "v", "r"]
TARGETS = ["du", "dv", "dr"]


class Vehicle:
    """Equations of motion without units (time in T, speed in U), drawn at random."""

    def __init__(self, seed):
        self.random = random = np.random.default_rng(seed)
        self.T, self.U, self.L = (self.log_uniform(*ends) for ends in ((.4, 20), (.2, 4), (.4, 20)))
        rate = self.log_uniform(3, 30) / self.T
        self.rate = float(min(100, max(1, round(rate, 1 if self.T > 3 else 0))))
        self.rows = int(random.integers(3000, 9000))
        self.ship = random.random() < 0.3
        self.mass = np.diag([1, random.uniform(1.1, 1.9), random.uniform(.7, 1.6)])
        self.xg = self.mass[1, 2] = self.mass[2, 1] = random.uniform(-.15, .15)
        self.linear = random.uniform(.1, 1.2, 3) * [1, 1.5, 1.2]
        self.quadratic = random.uniform(.2, 1.5, 3) * [1, 2, 1.5]
        self.cross = random.uniform(-.4, .4, 4)
        step = 1 / self.rate
        self.delay = int(random.uniform(0, .3) * self.T / step) if random.random() < .4 else 0
        self.lag = 0.0 if random.random() < .3 else random.uniform(.02, .5) * self.T
        self.law = random.choice(["lin", "quad", "dead"])
        self.astern = random.uniform(.5, 1) if random.random() < .5 else 1.0
        self.thrusters = 2 if self.ship else int(random.integers(2, 7))
        self.draw_allocation()
        self.drive = random.choice(["prbs", "sines", "wayp", "steps"])
        self.waves = random.uniform(0, .25) if random.random() < .5 else 0.0
        self.current = np.zeros(2)
        if random.random() < .4:
            speed, heading = random.uniform(0, .3), random.uniform(0, 6)
            self.current = speed * np.array([np.cos(heading), np.sin(heading)])
        self.unit = random.choice(["one", "pwm", "pct", "rpm"])
        self.phases = random.uniform(0, 6, (self.thrusters, 4))
        self.frequencies = random.uniform(.02, .35, (self.thrusters, 4)) / self.T
        self.change = random.choice(["thr", "mass", "drag"])
        self.failing = int(random.integers(self.thrusters))
        self.wave_rate = random.uniform(.5, 2.) / self.T
        self.effect = np.ones(self.thrusters)
        self.hold = 0.0
        self.command = np.zeros(self.thrusters)
        self.reference = np.zeros(3)

    def log_uniform(self, low, high):
        return float(np.exp(self.random.uniform(np.log(low), np.log(high))))

    def draw_allocation(self):
        allocation = self.random.normal(0, 1, (3, self.thrusters))
        allocation = 1.3 * allocation / (np.linalg.norm(allocation, axis=1, keepdims=True) + 1e-9)
        if self.thrusters == 2 and not self.ship:
            allocation = np.array([[1, 1], [0, 0], [.9, -.9]])
        self.allocation = allocation

    @property
    def first_changed(self):
        """The first row after the change."""
        return int(self.rows * .6)

    def fail(self):
        if self.change == "thr":
            self.effect[self.failing] = self.random.uniform(0, .5)
        elif self.change == "mass":
            self.mass = self.mass + np.diag([.3, .3, .3])
        else:
            self.quadratic, self.linear = 2 * self.quadratic, 1.4 * self.linear

    def commands(self, t, v):
        """The commands at t [s], for the velocity v."""
        random = self.random
        if self.drive == "sines":
            waves = np.sin(self.phases + self.frequencies * 2 * np.pi * t).sum(1)
            self.command = np.clip(waves / 2.2, -1, 1)
            if self.ship:
                self.command[0] = .6 + .35 * self.command[0]
        elif self.drive == "wayp":
            if t >= self.hold:
                self.hold = t + random.exponential(12 * self.T)
                wanted = [random.uniform(*ends) for ends in ((0, .8), (-.3, .3), (-.7, .7))]
                self.reference = np.array(wanted) * (random.random() < .85)
            if self.ship:
                turn = -1.5 * (self.reference[2] - v[2])
                self.command = np.clip([self.reference[0] + .3, turn], -1, 1)
            else:
                wanted = np.linalg.pinv(self.allocation) @ (2.0 * (self.reference - v))
                self.command = np.clip(wanted, -1, 1)
        elif t >= self.hold:
            self.hold = t + random.exponential((1.5 if self.drive == "prbs" else 5) * self.T)
            if self.drive == "steps":
                self.command = random.uniform(-1, 1, self.thrusters)
            else:
                signs = np.where(random.random(self.thrusters) < .5, -1, 1)
                self.command = signs * random.uniform(.2, .9)
            if self.ship:
                self.command[0] = random.uniform(.3, 1)
        return self.command

    def thrust(self, c):
        force = {"lin": c, "quad": c * abs(c),
                 "dead": np.sign(c) * np.maximum(abs(c) - .08, 0) / .92}[self.law]
        return np.where(force < 0, force * self.astern, force) * self.effect

    def force(self, thrust, v):
        if not self.ship:
            return self.allocation @ thrust
        inflow = max(0, .8 * v[0]) + .5 * thrust[0]
        rudder = -inflow * abs(inflow) * thrust[1] * .8
        return np.array([1.4 * thrust[0] - .4 * thrust[0] * v[0] - .1 * abs(rudder * thrust[1]),
                         rudder * .5, -rudder])

    def acceleration(self, t, v, heading, thrust):
        w, m, xg = self.wave_rate, self.mass, self.xg
        waves = self.waves * np.array([np.sin(w * 6 * t), np.cos(w * 5.3 * t + 1),
                                       np.sin(w * 5.1 * t + 2)])
        c, s, (north, east) = np.cos(heading), np.sin(heading), self.current
        vr = v - np.array([c * north + s * east, -s * north + c * east, 0])
        coriolis = np.array([-m[1, 1] * vr[1] * v[2] - xg * v[2]**2, m[0, 0] * vr[0] * v[2],
                             (m[1, 1] - m[0, 0]) * vr[0] * vr[1] * .5 + xg * vr[0] * v[2]])
        cross = self.cross
        drag = self.linear * vr + self.quadratic * abs(vr) * vr + np.array([
            0, cross[0] * abs(v[2]) * vr[1] + cross[1] * vr[0] * v[2],
            cross[2] * abs(vr[1]) * v[2] + cross[3] * vr[0] * vr[1]])
        return self.inverse_mass @ (self.force(thrust, v) - coriolis - drag + waves)

    def simulate(self, changes):
        """Velocities, accelerations and commands of all rows, without units."""
        step = 1 / self.rate
        parts = max(5, int(np.ceil(step / (.02 * self.T))))
        h = step / parts
        self.inverse_mass = np.linalg.inv(self.mass)
        v, thrust, heading = np.zeros(3), np.zeros(self.thrusters), 0.0
        sent = [np.zeros(self.thrusters)] * (self.delay + 1)
        velocities, accelerations = np.zeros((self.rows, 3)), np.zeros((self.rows, 3))
        commands = np.zeros((self.rows, self.thrusters))
        for i in range(self.rows):
            t = i * step
            if changes and i == self.first_changed:
                self.fail()
                self.inverse_mass = np.linalg.inv(self.mass)
            commands[i], velocities[i] = self.commands(t, v), v
            sent.append(commands[i].copy())
            for part in range(parts):
                wanted = self.thrust(sent[-1 - self.delay])
                thrust = wanted if self.lag == 0 else thrust + (wanted - thrust) * min(1, h / self.lag)
                a = self.acceleration(t, v, heading, thrust)
                if part == 0:
                    accelerations[i] = a
                v = np.clip(v + h / self.T * a, -8, 8)
                heading += h / self.T * v[2] * self.U * self.T / self.L
        return velocities, accelerations, commands

    def log(self, changes):
        """Columns u, v, r, commands, du, dv, dr as sensors tell them."""
        random, step = self.random, 1 / self.rate
        velocities, accelerations, commands = self.simulate(changes)
        units = np.array([self.U, self.U, self.U / self.L])
        v, a = velocities * units, accelerations * units / self.T
        v = v + random.normal(0, 1, v.shape) * v.std(0) * random.uniform(.002, .03)
        if random.random() < .5:
            a = a + random.normal(0, 1, a.shape) * a.std(0) * random.uniform(.02, .25)
        else:
            w = int(max(1, round(.15 * self.T / step)))
            window = np.ones(2 * w + 1) / (2 * w + 1)
            smooth = [np.convolve(np.pad(one, w, mode="edge"), window, "valid") for one in v.T]
            a = np.gradient(np.column_stack(smooth), step, axis=0)
        commands = {"one": commands, "pwm": 1500 + 400 * commands, "pct": 100 * commands,
                    "rpm": 3000 * commands}[self.unit]
        return np.column_stack([v, commands, a])


def learn(kelpie, folder, rows, held, vehicle):
    """R² at the end of kelpie and of least squares, by axis."""
    commands = [f"c{k}" for k in range(vehicle.thrusters)]
    folder.mkdir(parents=True, exist_ok=True)
    np.savetxt(folder / "log.csv", np.column_stack([rows, held]), delimiter=",", fmt="%.7g",
               header=",".join(NAMES + commands + TARGETS + ["held"]), comments="")
    subprocess.run([kelpie, "learn", folder / "log.csv", "--inputs", ",".join(NAMES + commands),
                    "--targets", ",".join(TARGETS), "--rate", str(vehicle.rate), "--split",
                    "column:held", "--out", folder / "learned"], check=True, capture_output=True)
    axes = json.loads((folder / "learned" / "result.json").read_text())["axes"]
    return {axis["name"]: {"kelpie": axis["r2"]["final"],
                           "least_squares": axis["yardsticks"]["least_squares"]["r2_final"]}
            for axis in axes}


def without_change(kelpie, folder, vehicle):
    rows = vehicle.log(changes=False)
    return learn(kelpie, folder, rows, np.arange(len(rows)) * 25 // len(rows) % 5 == 4, vehicle)


def with_change(kelpie, folder, vehicle):
    rows = vehicle.log(changes=True)
    first = vehicle.first_changed
    blocks = np.arange(len(rows)) * 25 // len(rows)
    held = (np.arange(len(rows)) >= first) & (blocks % 3 == 2)
    found = learn(kelpie, folder, rows, held, vehicle)
    begun = learn(kelpie, folder / "begun", rows[first:], held[first:], vehicle)
    return {axis: {"kelpie": r2["kelpie"], "begun": begun[axis]["kelpie"]}
            for axis, r2 in found.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--base", type=int, default=77000)
    parser.add_argument("--vehicles", type=int, default=24)
    parser.add_argument("--kelpie", default="build/release/kelpie")
    parser.add_argument("--change", action="store_true")
    arguments = parser.parse_args()
    found = {}
    other = "begun" if arguments.change else "least_squares"
    for seed in range(arguments.base, arguments.base + arguments.vehicles):
        vehicle = Vehicle(seed)
        name = str(seed)
        measure = with_change if arguments.change else without_change
        found[name] = measure(arguments.kelpie, arguments.out / name, vehicle)
        print(name, f"{vehicle.drive:6s}", f"{vehicle.rate:5.1f} Hz ", "  ".join(
            f"{axis} {r2['kelpie']:6.3f} ({r2[other]:6.3f})"
            for axis, r2 in found[name].items()), vehicle.change if arguments.change else "",
            flush=True)
    (arguments.out / "vehicles.json").write_text(json.dumps(found, indent=1))
    behind = [r2[other] - r2["kelpie"] for axes in found.values() for r2 in axes.values()]
    print(f"{len(behind)} axes: {sum(b > .02 for b in behind)} more than 0.02 behind "
          f"{'kelpie begun at the change' if arguments.change else 'least squares'}, "
          f"largest {max(behind):.3f}")


if __name__ == "__main__":
    main()
