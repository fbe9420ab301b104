// SPDX-License-Identifier: Apache-2.0
// The other implementation of ULog that kelpie's is checked against.
//
//   npm install --prefix /tmp/ulog-peer @foxglove/ulog@2.3.2
//   export NODE_PATH=/tmp/ulog-peer/node_modules
//   node scripts/ulog_peer.mjs FILE.ulg    # counts and hashes of all values, as tests have them

import { createRequire } from "node:module";

const require = createRequire(process.env.NODE_PATH ? process.env.NODE_PATH + "/" : import.meta.url);
const { ULog, MessageType } = require("@foxglove/ulog");
const { FileReader } = require("@foxglove/ulog/node");

// All numbers of a message in the order of its format; text counts for nothing.
const numbersOf = (value) =>
  typeof value === "string" ? []
  : Array.isArray(value) || ArrayBuffer.isView(value) ? Array.from(value).flatMap(numbersOf)
  : typeof value === "object" ? Object.values(value).flatMap(numbersOf)
  : [Number(value)];

// FNV-1a over the bytes of all numbers, as doubles; what isn't a number counts as 0.
function hash(values) {
  let state = 0x811c9dc5;
  const doubles = Float64Array.from(values, (value) => (Number.isNaN(value) ? 0 : value));
  for (const byte of new Uint8Array(doubles.buffer)) state = Math.imul(state ^ byte, 0x01000193) >>> 0;
  return state;
}

const log = new ULog(new FileReader(process.argv[2]));
await log.open();
const found = new Map();
for await (const message of log.readMessages()) {
  if (message.type !== MessageType.Data) continue;
  const { name, multiId } = log.subscriptions.get(message.msgId);
  const topic = multiId ? `${name}[${multiId}]` : name;
  // The messages come in the order of their times, so their hashes are added up.
  const entry = found.get(topic) ?? { count: 0, sum: 0 };
  found.set(topic, { count: entry.count + 1, sum: (entry.sum + hash(numbersOf(message.value))) >>> 0 });
}
for (const [topic, { count, sum }] of [...found].sort())
  console.log(`{"${topic}", {${count}, ${sum}U}},`);
