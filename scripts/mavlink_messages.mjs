// SPDX-License-Identifier: Apache-2.0
// Prints src/logs/mavlink/messages.inc: what fields the messages of MAVLink's sets minimal, standard,
// common and ardupilotmega have, in the order they are sent in.
//
//   npm install --prefix /tmp/mavlink-peer node-mavlink@2.3.0
//   export NODE_PATH=/tmp/mavlink-peer/node_modules
//   node scripts/mavlink_messages.mjs > src/logs/mavlink/messages.inc
//   node scripts/mavlink_messages.mjs check    # number, name, checksum and lengths, a line each

import { createRequire } from "node:module";

const require = createRequire(process.env.NODE_PATH ? process.env.NODE_PATH + "/" : import.meta.url);
const mappings = require("mavlink-mappings");

const messages = new Map();
for (const set of ["minimal", "standard", "common", "ardupilotmega"])
  for (const [id, message] of Object.entries(mappings[set].REGISTRY)) messages.set(Number(id), message);
const sorted = [...messages].sort((a, b) => a[0] - b[0]);

function fieldText({ type, length, source, units }) {
  const word = type.replace("_mavlink_version", "").replace("[]", "");
  return `${word}${length ? `[${length}]` : ""} ${source}${units ? " " + units : ""}`;
}

function lines(text) {
  const made = [""];
  for (const word of text.split(" ")) {
    if (made.at(-1).length + word.length > 96) made.push("   ");
    made[made.length - 1] += (made.at(-1) ? " " : "") + word;
  }
  return made.join("\n");
}

if (process.argv[2] === "check") {
  for (const [id, { MSG_NAME, MAGIC_NUMBER, FIELDS }] of sorted) {
    const bytes = (fields) => fields.reduce((sum, { size, length }) => sum + size * (length || 1), 0);
    console.log(id, MSG_NAME, MAGIC_NUMBER, bytes(FIELDS.filter((f) => !f.extension)), bytes(FIELDS));
  }
} else {
  console.log('R"(');
  for (const [id, { MSG_NAME, FIELDS }] of sorted) {
    const parts = [false, true].map((extension) =>
      FIELDS.filter((field) => field.extension === extension).map(fieldText).join(", "));
    console.log(lines(`${id} ${MSG_NAME}: ${parts.filter((part) => part).join(" | ")}`));
  }
  console.log(')"');
}
