// SPDX-License-Identifier: BSD-3-Clause
// Writes the MCAP files of this folder, and what an independent reader finds in them: topic, log time [ns], size and
// CRC-32 of every message, in the order of the times. It is the same for all files (messages.txt), except unfinished.
// Node 20; npm install @mcap/core@2.2.2 @mcap/support@1.1.0 (@foxglove/wasm-zstd@1.0.1); lz4 1.9.4 of Debian.
// Usage: node make.mjs FOLDER_WITH_node_modules
import { execFileSync } from "child_process";
import { createRequire } from "module";
import fs from "fs";
const require = createRequire(process.argv[2] + "/");
const { McapWriter, McapStreamReader } = require("@mcap/core");
const { loadDecompressHandlers } = require("@mcap/support");
const zstd = require("@foxglove/wasm-zstd");
const decompressHandlers = await loadDecompressHandlers();
await zstd.isLoaded;

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (0xedb88320 & -(crc & 1));
  }
  return (~crc >>> 0).toString(16).padStart(8, "0");
}

const compressions = {
  none: undefined,
  lz4: (data) => ({ compression: "lz4", compressedData: execFileSync("lz4", ["-c", "-"], { input: data }) }),
  zstd: (data) => ({ compression: "zstd", compressedData: zstd.compress(data) }),
};

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
  bytes() {
    return Buffer.concat(this.parts);
  }
}

async function written(profile, compression, options = {}, finish = true) {
  const writable = new Memory();
  const writer = new McapWriter({ writable, chunkSize: 1500, compressChunk: compressions[compression], ...options });
  await writer.start({ profile, library: "make.mjs" });
  const ros2 = profile === "ros2";
  const middle = ros2 ? "/msg/" : "/";
  const topics = [
    ["/points", "sensor_msgs" + middle + "PointCloud2"],
    ["/tf", (ros2 ? "tf2_msgs" : "tf") + middle + "TFMessage"],
    ["/odom", "nav_msgs" + middle + "Odometry"],
    ["/tf", (ros2 ? "tf2_msgs" : "tf") + middle + "TFMessage"], // a second sender
    ["/diagnostics", "diagnostics"],
  ];
  const channels = [];
  for (const [topic, name] of topics) {
    const encoding = ros2 ? "ros2msg" : "ros1msg";
    const schemaId = await writer.registerSchema({ name, encoding, data: Buffer.from("float64 x") });
    const messageEncoding = name === "diagnostics" ? "json" : ros2 ? "cdr" : "ros1";
    channels.push(await writer.registerChannel({ schemaId, topic, messageEncoding, metadata: new Map() }));
  }
  await writer.addMetadata({ name: "note", metadata: new Map([["key", "value"]]) });
  for (let i = 0; i < 40; ++i) {
    const channel = i === 39 ? 4 : i % 4;
    const size = i === 7 ? 0 : channel === 0 ? 300 + i : 20 + i;
    const data = Buffer.alloc(size);
    for (let k = 0; k < size; ++k) data[k] = k < 4 ? (k === 1 ? 1 : 0) : (i + (k >> 3)) & 255;
    // Some messages come late: a bag is not always in the order of the times.
    const logTime = 1700000000000000000n + BigInt(i % 5 === 3 ? i - 3 : i) * 50000000n;
    await writer.addMessage({ channelId: channels[channel], sequence: i, logTime, publishTime: logTime - 5n, data });
    if (i === 20)
      await writer.addAttachment({ logTime, createTime: logTime, name: "a.txt", mediaType: "text/plain", data: Buffer.from("hello") });
  }
  if (finish) await writer.end();
  return writable.bytes();
}

function listed(bytes) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(bytes);
  const channels = new Map();
  const messages = [];
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Channel") channels.set(record.id, record.topic);
    if (record.type === "Message")
      messages.push([record.logTime, `${channels.get(record.channelId)} ${record.logTime} ${record.data.length} ${crc32(record.data)}`]);
  }
  messages.sort((a, b) => (a[0] < b[0] ? -1 : a[0] > b[0] ? 1 : 0)); // stable
  return messages.map((message) => message[1] + "\n").join("");
}

const files = {
  "ros2_none": await written("ros2", "none"),
  "ros2_lz4": await written("ros2", "lz4"),
  "ros2_zstd": await written("ros2", "zstd"),
  "ros1_zstd": await written("ros1", "zstd"),
  "no_chunks": await written("ros2", "none", { useChunks: false }),
  "no_index": await written("ros2", "zstd", { useMessageIndex: false, useChunkIndex: false, useStatistics: false }),
  "no_summary": await written("ros2", "lz4", { repeatSchemas: false, repeatChannels: false, useSummaryOffsets: false, useStatistics: false, useChunkIndex: false }),
  "unfinished": await written("ros2", "zstd", {}, false),
};
for (const [name, bytes] of Object.entries(files)) {
  fs.writeFileSync(name + ".mcap", bytes);
  const list = name === "unfinished" ? "unfinished.txt" : "messages.txt";
  if (list === "messages.txt" && name !== "ros2_none" && fs.readFileSync(list, "utf8") !== listed(bytes))
    throw new Error(name + " has other messages than ros2_none");
  fs.writeFileSync(list, listed(bytes));
}
