// SPDX-License-Identifier: Apache-2.0
// The other implementation of MAVLink that kelpie's is checked against.
//
//   npm install --prefix /tmp/mavlink-peer node-mavlink@2.3.0
//   export NODE_PATH=/tmp/mavlink-peer/node_modules
//   node scripts/mavlink_peer.mjs read FILE.tlog    # counts and hashes of all values, as tests have them
//   node scripts/mavlink_peer.mjs count FILE.tlog   # frames with a right checksum, frame by frame
//   node scripts/mavlink_peer.mjs write             # frames in hex, as tests/logs/mavlink has them
//   echo HEX... | node scripts/mavlink_peer.mjs hear   # what frames say that kelpie wrote, and
//                                                      # whether the key of "secret" signed them

import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { PassThrough } from "node:stream";

const require = createRequire(process.env.NODE_PATH ? process.env.NODE_PATH + "/" : import.meta.url);
const mavlink = require("node-mavlink");
const { minimal, standard, common, ardupilotmega, MSG_ID_MAGIC_NUMBER } = require("mavlink-mappings");
const registry = Object.assign(
  {}, minimal.REGISTRY, standard.REGISTRY, common.REGISTRY, ardupilotmega.REGISTRY);

async function packetsOf(bytes) {
  const packets = [];
  const reader = mavlink.createMavLinkStream(new PassThrough().end(bytes));
  for await (const packet of reader) packets.push(packet);
  return packets;
}

// All numbers of a message; text counts for nothing.
function numbersOf(packet) {
  const message = packet.protocol.data(packet.payload, registry[packet.header.msgid]);
  return registry[packet.header.msgid].FIELDS.flatMap((field) => {
    const value = message[field.name];
    return typeof value === "string" ? [] : [value].flat().map(Number);
  });
}

async function read(file) {
  const log = readFileSync(file);
  const frames = [];
  for (let at = 8; at < log.length; ) {
    const second = log[at] === 0xfd;
    const size = (second ? 12 : 8) + log[at + 1] + (second && (log[at + 2] & 1) ? 13 : 0);
    frames.push(log.subarray(at, at + size));
    at += size + 8;
  }
  // FNV-1a over the bytes of all numbers, as doubles; what isn't a number counts as 0.
  const hash = (start, values) => {
    let state = start;
    for (const byte of new Uint8Array(Float64Array.from(values).buffer))
      state = Math.imul(state ^ byte, 0x01000193) >>> 0;
    return state;
  };
  const found = new Map();
  for (const packet of await packetsOf(Buffer.concat(frames))) {
    const id = packet.header.msgid;
    if (!registry[id]) continue;
    const entry = found.get(id) ?? { count: 0, state: 0x811c9dc5 };
    const values = numbersOf(packet).map((value) => (Number.isNaN(value) ? 0 : value));
    found.set(id, { count: entry.count + 1, state: hash(entry.state, values) });
  }
  console.log("frames", frames.length);
  for (const [id, { count, state }] of [...found].sort((a, b) => a[0] - b[0]))
    console.log(`{"${registry[id].MSG_NAME}", {${count}, ${state}U}},`);
}

// Frame by frame as the file has them: a stream of node-mavlink loses sound frames beside damaged.
function count(file) {
  const log = readFileSync(file);
  const found = {};
  let damaged = 0;
  for (let at = 8; at < log.length; ) {
    const second = log[at] === 0xfd;
    const head = second ? 10 : 6;
    const end = at + head + log[at + 1];
    const id = second ? log.readUIntLE(at + 7, 3) : log[at + 5];
    const right =
      registry[id] && mavlink.x25crc(log.subarray(at, end), 1, 0, MSG_ID_MAGIC_NUMBER[id]);
    if (registry[id] && right === log.readUInt16LE(end))
      found[registry[id].MSG_NAME] = (found[registry[id].MSG_NAME] ?? 0) + 1;
    else damaged += 1;
    at = end + 2 + (second && (log[at + 2] & 1) ? 13 : 0) + 8;
  }
  for (const [name, frames] of Object.entries(found)) console.log(`{"${name}", ${frames}},`);
  console.log("without a right checksum", damaged);
}

function write() {
  const attitude = Object.assign(new common.Attitude(), { timeBootMs: 1234, roll: 0.5, yaw: -2 });
  const command = Object.assign(new common.CommandLong(), {
    command: 511, targetSystem: 1, targetComponent: 1, _param1: 36, _param2: 50000,
  });
  const text = Object.assign(new common.StatusText(), { severity: 4, text: "hull touched" });
  for (const protocol of [new mavlink.MavLinkProtocolV1(7, 9), new mavlink.MavLinkProtocolV2(7, 9)])
    for (const message of [attitude, command, text])
      console.log(message.constructor.MSG_NAME, protocol.serialize(message, 3).toString("hex"));
  const key = mavlink.MavLinkPacketSignature.key("secret");
  const signed = new mavlink.MavLinkProtocolV2(7, 9, mavlink.MavLinkProtocolV2.IFLAG_SIGNED);
  const frame = signed.sign(signed.serialize(attitude, 4), 1, key, 1700000000000);
  console.log("ATTITUDE signed", frame.toString("hex"));
}

async function hear() {
  const bytes = Buffer.from(readFileSync(0, "utf8").replace(/\s/g, ""), "hex");
  for (const packet of await packetsOf(bytes))
    console.log(
      registry[packet.header.msgid].MSG_NAME, packet.header.sysid, packet.header.compid,
      packet.header.seq,
      JSON.stringify(packet.protocol.data(packet.payload, registry[packet.header.msgid])),
      packet.signature?.matches(mavlink.MavLinkPacketSignature.key("secret")) ?? "unsigned",
    );
}

const [command, file] = process.argv.slice(2);
if (command === "read") await read(file);
else if (command === "count") count(file);
else if (command === "write") write();
else if (command === "hear") await hear();
else {
  console.error("usage: mavlink_peer.mjs read FILE | count FILE | write | hear");
  process.exit(2);
}
