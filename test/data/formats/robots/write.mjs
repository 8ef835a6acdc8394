// SPDX-License-Identifier: BSD-3-Clause
// Writes MCAP files, or messages of ROS 2 for databases (.cdr.json). make.py calls it.
// Usage: node write.mjs FOLDER_WITH_node_modules RECORDINGS.json
import { execFileSync } from "child_process";
import { createRequire } from "module";
import fs from "fs";
const require = createRequire(process.argv[2] + "/");
const { McapWriter } = require("@mcap/core");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
const { ros2humble } = require("@foxglove/rosmsg-msgs-common");
const zstd = require("@foxglove/wasm-zstd");
await zstd.isLoaded;

const compressions = {
  none: undefined,
  lz4: (data) => ({ compression: "lz4", compressedData: execFileSync("lz4", ["-9c", "-"], { input: data }) }),
  zstd: (data) => ({ compression: "zstd", compressedData: zstd.compress(data, 19) }),
};

// The definition of a type, followed by those of the types in it.
function definitionsOf(type, found = new Map()) {
  if (found.has(type)) return found;
  found.set(type, ros2humble[type]);
  for (const field of ros2humble[type].definitions) if (field.isComplex) definitionsOf(field.type, found);
  return found;
}
const writers = new Map();
function serialised(type, value) {
  if (!writers.has(type)) {
    const all = [...definitionsOf(type).values()];
    writers.set(type, new MessageWriter([{ definitions: all[0].definitions }, ...all.slice(1)]));
  }
  return writers.get(type).writeMessage(value);
}
// Bytes are written as {"base64": "..."}.
function withBytes(value) {
  if (Array.isArray(value)) return value.map(withBytes);
  if (value === null || typeof value !== "object") return value;
  if ("base64" in value) return new Uint8Array(Buffer.from(value.base64, "base64"));
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, withBytes(one)]));
}

class Memory {
  parts = [];
  size = 0n;
  async write(bytes) {
    this.parts.push(Buffer.from(bytes));
    this.size += BigInt(bytes.byteLength);
  }
  position() {
    return this.size;
  }
}

async function mcap(recording) {
  const writable = new Memory();
  const compressChunk = compressions[recording.compression];
  const writer = new McapWriter({ writable, chunkSize: recording.chunk, compressChunk });
  await writer.start({ profile: "ros2", library: "write.mjs" });
  const channels = new Map();
  for (const [topic, type, time, value] of recording.messages) {
    if (!channels.has(topic)) {
      const name = type.replace("/", "/msg/");
      const schemaId = await writer.registerSchema({ name, encoding: "ros2msg", data: Buffer.from("") });
      const channel = { schemaId, topic, messageEncoding: "cdr", metadata: new Map() };
      channels.set(topic, await writer.registerChannel(channel));
    }
    const logTime = BigInt(time);
    const data = serialised(type, withBytes(value));
    await writer.addMessage({ channelId: channels.get(topic), sequence: 0, logTime, publishTime: logTime, data });
  }
  if (recording.finished) await writer.end();
  return Buffer.concat(writable.parts);
}

for (const recording of JSON.parse(fs.readFileSync(process.argv[3], "utf8"))) {
  if (recording.name.endsWith(".mcap")) {
    fs.writeFileSync(recording.name, await mcap(recording));
    continue;
  }
  const messages = recording.messages.map(([topic, type, time, value]) =>
    [topic, type.replace("/", "/msg/"), time, Buffer.from(serialised(type, withBytes(value))).toString("base64")]);
  fs.writeFileSync(recording.name, JSON.stringify(messages));
}
