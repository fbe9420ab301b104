// SPDX-License-Identifier: Apache-2.0
// A simulated vehicle that speaks MAVLink by another implementation than kelpie's, on this machine:
//
//   npm install --prefix /tmp/mavlink-peer node-mavlink@2.3.0
//   export NODE_PATH=/tmp/mavlink-peer/node_modules
//   node scripts/mavlink_vehicle.mjs config > /tmp/mavlink-peer/vehicle.toml
//   kelpie live --config /tmp/mavlink-peer/vehicle.toml --out /tmp/mavlink-peer/out --fresh &
//   node scripts/mavlink_vehicle.mjs drive 40     # seconds
//
// It sends HEARTBEAT, ATTITUDE, LOCAL_POSITION_NED and SERVO_OUTPUT_RAW to 127.0.0.1:14550, at 4 Hz
// until faster rates are asked for, and prints what comes back. Exit code 1 where no predictions
// came, they aren't near what it did, or a frame was damaged.

import { createSocket } from "node:dgram";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { PassThrough } from "node:stream";

const require = createRequire(process.env.NODE_PATH ? process.env.NODE_PATH + "/" : import.meta.url);
const { createMavLinkStream, MavLinkProtocolV2 } = require("node-mavlink");
const { minimal, common } = require("mavlink-mappings");
const registry = { ...minimal.REGISTRY, ...common.REGISTRY };
const HOST = "127.0.0.1";
const PORT = 14550;
const STEP_S = 0.005;
const SET_MESSAGE_INTERVAL = 511;

const LIVE = `[live]
align = "none"
[live.mavlink]
connection = "udp:${PORT}"
`;

function config() {
  const names = ["left", "right"];
  const line = (name, k) => `${name} = "SERVO_OUTPUT_RAW:servo${k + 1}_raw"`;
  return readFileSync(new URL("mavlink_log.toml", import.meta.url), "utf8")
    .replace("{inputs}", names.map((name) => `"${name}"`).join(", "))
    .replace("{commands}", names.map(line).join("\n")) + LIVE;
}

// Surge and yaw, by one thruster on either side.
class Vehicle {
  t = 0;
  u = 0;
  r = 0;
  psi = 0;
  speed = [0, 0];

  go() {
    this.t += STEP_S;
    this.speed = [0, 1].map((side) =>
      8 * Math.sin(0.31 * this.t + 1.7 * side) + 4 * Math.sin(0.83 * this.t + side));
    const [left, right] = this.speed.map((n) => n * Math.abs(n));
    this.udot = 0.006 * (left + right) - 1.4 * this.u * Math.abs(this.u) - 0.3 * this.u;
    this.rdot = 0.02 * (left - right) - 1.1 * this.r * Math.abs(this.r) - 0.5 * this.r;
    this.u += STEP_S * this.udot;
    this.r += STEP_S * this.rdot;
    this.psi = Math.atan2(Math.sin(this.psi + STEP_S * this.r), Math.cos(this.psi + STEP_S * this.r));
  }

  message(Type) {
    const timeBootMs = Math.round(1000 * this.t);
    const fields = {
      HEARTBEAT: { type: 12, autopilot: 3, systemStatus: 4, mavlinkVersion: 3 },  // ArduPilot
      ATTITUDE: { timeBootMs, yaw: this.psi, yawspeed: this.r },
      LOCAL_POSITION_NED: {
        timeBootMs, vx: this.u * Math.cos(this.psi), vy: this.u * Math.sin(this.psi),
      },
      SERVO_OUTPUT_RAW: {
        timeUsec: Math.round(1e6 * this.t), servo1Raw: Math.round(1500 + 40 * this.speed[0]),
        servo2Raw: Math.round(1500 + 40 * this.speed[1]),
      },
    }[Type.MSG_NAME];
    return Object.assign(new Type(), fields);
  }
}

function drive(seconds) {
  const socket = createSocket("udp4");
  const protocol = new MavLinkProtocolV2(1, 1);
  const vehicle = new Vehicle();
  const rates = new Map([[minimal.Heartbeat, 1], [common.Attitude, 4], [common.LocalPositionNed, 4],
                         [common.ServoOutputRaw, 4]]);
  const due = new Map([...rates.keys()].map((type) => [type, 0]));
  const errors = { udot: [], rdot: [] };  // of what was predicted, and what it was said of
  let sequence = 0;
  let damaged = 0;
  const send = (message) =>
    socket.send(protocol.serialize(message, sequence++ % 256), PORT, HOST);

  const hear = (packet) => {
    const Type = registry[packet.header.msgid];
    if (!Type) return;
    const message = packet.protocol.data(packet.payload, Type);
    if (Type === common.CommandLong && message.command === SET_MESSAGE_INTERVAL) {
      const asked = [...rates.keys()].find((type) => type.MSG_ID === message._param1);
      if (asked) rates.set(asked, 1e6 / message._param2);
      send(Object.assign(new common.CommandAck(),
                         { command: message.command, result: asked ? 0 : 3 }));
      if (asked) console.log(`${asked.MSG_NAME} at ${rates.get(asked)} Hz from now on`);
    } else if (Type === common.NamedValueFloat) {
      const name = message.name.replace(/\0.*/s, "");
      errors[name]?.push([message.value, vehicle[name]]);
    } else if (Type === common.StatusText) {
      console.log(`it says: ${message.text.replace(/\0.*/s, "")}`);
    }
  };
  const bytes = new PassThrough();
  createMavLinkStream(bytes, { onCrcError: () => ++damaged }).on("data", hear);
  socket.on("message", (data) => bytes.write(data));

  const began = performance.now();
  const timer = setInterval(() => {
    while (vehicle.t < (performance.now() - began) / 1000) {
      vehicle.go();
      for (const [type, rate] of rates) {
        if (vehicle.t < due.get(type)) continue;
        due.set(type, due.get(type) + 1 / rate);
        send(vehicle.message(type));
      }
    }
    if (vehicle.t < seconds) return;
    clearInterval(timer);
    socket.close();
    let isWell = damaged === 0;
    for (const [name, pairs] of Object.entries(errors)) {
      const last = pairs.slice(pairs.length / 2);
      const sum = (values) => values.reduce((total, value) => total + value, 0);
      const mean = sum(last.map(([, truth]) => truth)) / last.length;
      const r2 = 1 - sum(last.map(([said, truth]) => (said - truth) ** 2)) /
                     sum(last.map(([, truth]) => (truth - mean) ** 2));
      console.log(`${name}: ${pairs.length} predictions; R² of the second half ${r2.toFixed(3)}`);
      isWell &&= pairs.length > 0 && r2 > 0.5;
    }
    console.log(`${damaged} damaged frames`);
    process.exit(isWell ? 0 : 1);
  }, 1000 * STEP_S);
}

const [command, seconds] = process.argv.slice(2);
if (command === "config") process.stdout.write(config());
else if (command === "drive" && Number(seconds) > 0) drive(Number(seconds));
else {
  console.error("usage: mavlink_vehicle.mjs config | drive SECONDS");
  process.exit(2);
}
