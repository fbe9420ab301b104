// SPDX-License-Identifier: Apache-2.0
// The other implementation of MCAP that kelpie's reader and writer are checked against.
//
//   npm install --prefix /tmp/mcap-peer @mcap/core@2.2.2
//   export MCAP_CORE=/tmp/mcap-peer/node_modules/@mcap/core/dist/esm/index.js
//   node scripts/mcap_peer.mjs write tests/logs/bag/fixtures   # the fixtures of tests/logs/bag
//   node scripts/mcap_peer.mjs read FILE.mcap             # reads what kelpie wrote
//
// Wants the commands zstd and lz4.

import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const core = await import(process.env.MCAP_CORE ?? "@mcap/core");

const twist = `Vector3 linear
Vector3 angular
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
`;
const sample = `uint8 STATE_ON=1  # a constant
builtin_interfaces/Time stamp
string<=16 label "a # b"
float32[] speeds
Pair[<=3] pairs
bool on true
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: peer_msgs/Pair
int16 a
float64 b
`;

const packers = {
  zstd: (data) => execFileSync("zstd", ["-c", "-q"], { input: data }),
  lz4: (data) => execFileSync("lz4", ["-c", "-q"], { input: data }),
};
const unpackers = {
  zstd: (data) => execFileSync("zstd", ["-d", "-c", "-q"], { input: data }),
  lz4: (data) => execFileSync("lz4", ["-d", "-c", "-q"], { input: data }),
};

function twistBytes(k) {
  const view = new DataView(new ArrayBuffer(4 + 6 * 8));
  view.setUint8(1, 1); // little endian
  [0.1 * k, -k, 0, 0, 0, 1 / (k + 1)].forEach((x, i) => view.setFloat64(4 + 8 * i, x, true));
  return new Uint8Array(view.buffer);
}

// Big endian. Offsets count from behind the four bytes of the encapsulation.
function sampleBytes(k) {
  const view = new DataView(new ArrayBuffer(4 + 65));
  const body = new DataView(view.buffer, 4);
  body.setInt32(0, 100 + k);
  body.setUint32(4, 500000000);
  body.setUint32(8, 3); // "ok" and its NUL
  body.setUint8(12, "o".charCodeAt(0));
  body.setUint8(13, "k".charCodeAt(0));
  body.setUint32(16, 2);
  body.setFloat32(20, k + 0.5);
  body.setFloat32(24, -k);
  body.setUint32(28, 2);
  body.setInt16(32, -k);
  body.setFloat64(40, 10 * k);
  body.setInt16(48, k);
  body.setFloat64(56, 20 * k);
  body.setUint8(64, k % 2);
  return new Uint8Array(view.buffer);
}

async function write(folder, name, options) {
  const buffer = new core.TempBuffer();
  const writer = new core.McapWriter({ writable: buffer, ...options });
  await writer.start({ profile: "ros2", library: "peer" });
  const channel = async (topic, type, text) => {
    const data = new TextEncoder().encode(text);
    const schemaId = await writer.registerSchema({ name: type, encoding: "ros2msg", data });
    return writer.registerChannel({
      schemaId, topic, messageEncoding: "cdr", metadata: new Map([["offered_qos_profiles", "- 1"]]),
    });
  };
  const channels = [
    await channel("/cmd", "geometry_msgs/msg/Twist", twist),
    await channel("/sample", "peer_msgs/msg/Sample", sample),
  ];
  for (let k = 0; k < 12; ++k) {
    for (const [i, data] of [twistBytes(k), sampleBytes(k)].entries()) {
      const logTime = 100000000000n + BigInt(k) * 100000000n + BigInt(i) * 30000000n;
      await writer.addMessage({
        channelId: channels[i], sequence: k, logTime, publishTime: logTime - 1000n, data,
      });
    }
  }
  await writer.addMetadata({ name: "note", metadata: new Map([["a", "b"]]) });
  await writer.end();
  writeFileSync(join(folder, name), buffer.get());
}

async function read(file) {
  const content = readFileSync(file);
  const reader = await core.McapIndexedReader.Initialize({
    readable: new core.TempBuffer(content), decompressHandlers: unpackers,
  });
  let indexed = 0;
  let last = 0n;
  for await (const message of reader.readMessages()) {
    ++indexed;
    if (message.logTime < last) throw new Error("messages are not in the order of time");
    last = message.logTime;
  }
  const stream = new core.McapStreamReader({ decompressHandlers: unpackers, validateCrcs: true });
  stream.append(content);
  const records = {};
  for (let record; (record = stream.nextRecord()); ) {
    records[record.type] = (records[record.type] ?? 0) + 1;
  }
  const stated = Number(reader.statistics.messageCount);
  console.log(`${file}: statistics ${stated}, indexed ${indexed}, streamed`, records);
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    console.log(`  ${channel.topic}: ${schema.name} (${schema.encoding}, ${schema.data.length} B)`);
  }
  if (stated !== indexed || stated !== records.Message || !stream.done()) process.exit(1);
}

const [task, target] = process.argv.slice(2);
if (task === "write") {
  mkdirSync(target, { recursive: true });
  const packed = (compression) => ({
    chunkSize: 900,
    compressChunk: (data) => ({ compression, compressedData: packers[compression](data) }),
  });
  await write(target, "plain.mcap", { useChunks: false });
  await write(target, "chunks.mcap", {
    chunkSize: 900, useStatistics: false, useSummaryOffsets: false, repeatSchemas: false,
    repeatChannels: false, useMessageIndex: false, useChunkIndex: false, useMetadataIndex: false,
  });
  await write(target, "zstd.mcap", packed("zstd"));
  await write(target, "lz4.mcap", packed("lz4"));
} else if (task === "read") {
  await read(target);
} else {
  console.error("usage: mcap_peer.mjs write FOLDER | read FILE");
  process.exit(2);
}
