// SPDX-License-Identifier: BSD-3-Clause
// Writes scans and transforms as messages of ROS 2 into MCAP files and each message into a file of its own, with
// @mcap/core and @foxglove/rosmsg2-serialization. See make.py.
// Usage: node make_mcap.mjs TOOLS DESCRIPTION.json OUTPUT WORK
import { execFileSync } from "child_process";
import { createRequire } from "module";
import fs from "fs";
const [tools, description, output, work] = process.argv.slice(2);
const require = createRequire(tools + "/");
const { McapWriter } = require("@mcap/core");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
const { ros2humble } = require("@foxglove/rosmsg-msgs-common");
const zstd = require("@foxglove/wasm-zstd");
await zstd.isLoaded;

const types = { ...ros2humble };
function closure(type, found = new Map()) {
  if (found.has(type)) return found;
  found.set(type, types[type]);
  for (const f of types[type].definitions) if (f.isComplex) closure(f.type, found);
  return found;
}
function schemaText(type) {
  const line = (f) => (f.isConstant ? `${f.type} ${f.name}=${f.valueText ?? f.value}`
                                    : `${f.type}${f.isArray ? `[${f.arrayLength ?? ""}]` : ""} ${f.name}`);
  return [...closure(type)].map(([name, definition], i) =>
    (i === 0 ? "" : `${"=".repeat(80)}\nMSG: ${name}\n`) + definition.definitions.map(line).join("\n") + "\n").join("");
}
const writers = new Map();
function serialised(type, value) {
  if (!writers.has(type)) {
    const definitions = [...closure(type).values()].map((d, i) => (i === 0 ? { definitions: d.definitions } : d));
    writers.set(type, new MessageWriter(definitions));
  }
  return Buffer.from(writers.get(type).writeMessage(value));
}

const stamp = (ns) => ({ sec: Number(ns / 1000000000n), nanosec: Number(ns % 1000000000n) });
const transform = (ns, parent, child, [x, y, z], [qx, qy, qz, qw]) => ({
  header: { stamp: stamp(ns), frame_id: parent }, child_frame_id: child,
  transform: { translation: { x, y, z }, rotation: { x: qx, y: qy, z: qz, w: qw } } });

const topics = [["/tf_static", "tf2_msgs/TFMessage"], ["/tf", "tf2_msgs/TFMessage"],
                ["/points", "sensor_msgs/PointCloud2"]];
const said = JSON.parse(fs.readFileSync(description, "utf8"));
const start = BigInt(said.start), step = BigInt(said.step);
const messages = [{ topic: 0, time: start,
                    data: serialised(topics[0][1], { transforms: said.static.map((s) => transform(start, ...s)) }) }];
said.scans.forEach((scan, i) => {
  const time = start + BigInt(i) * step;
  const moved = transform(time, "odom", "base_link", ...scan.transform);
  messages.push({ topic: 1, time, data: serialised(topics[1][1], { transforms: [moved] }) });
  const data = new Uint8Array(fs.readFileSync(scan.file));
  const fields = ["x", "y", "z", "intensity"].map((name, k) => ({ name, offset: 4 * k, datatype: 7, count: 1 }));
  messages.push({ topic: 2, time: time + 30000000n, data: serialised(topics[2][1], {
    header: { stamp: stamp(time), frame_id: "lidar" }, height: 1, width: data.length / 16, fields, is_bigendian: false,
    point_step: 16, row_step: data.length, data, is_dense: true }) });
});

const compressions = {
  none: undefined,
  lz4: (data) => ({ compression: "lz4",
                    compressedData: execFileSync("lz4", ["-c", "-"], { input: data, maxBuffer: 2 ** 30 }) }),
  zstd: (data) => ({ compression: "zstd", compressedData: zstd.compress(data) }),
};
for (const [name, compressChunk] of Object.entries(compressions)) {
  const file = fs.openSync(`${output}/${name}.mcap`, "w");
  let size = 0n;
  const writable = {
    async write(bytes) {
      for (let done = 0; done < bytes.byteLength; ) done += fs.writeSync(file, bytes, done);
      size += BigInt(bytes.byteLength);
    },
    position: () => size,
  };
  const writer = new McapWriter({ writable, compressChunk });
  await writer.start({ profile: "ros2", library: "make_mcap.mjs" });
  const channels = [], schemas = new Map();
  for (const [topic, type] of topics) {
    if (!schemas.has(type))
      schemas.set(type, await writer.registerSchema({ name: type.replace("/", "/msg/"), encoding: "ros2msg",
                                                      data: Buffer.from(schemaText(type)) }));
    channels.push(await writer.registerChannel({ schemaId: schemas.get(type), topic, messageEncoding: "cdr",
                                                 metadata: new Map() }));
  }
  for (const [sequence, { topic, time, data }] of messages.entries())
    await writer.addMessage({ channelId: channels[topic], sequence, logTime: time, publishTime: time, data });
  await writer.end();
  fs.closeSync(file);
}

messages.forEach((message, i) => fs.writeFileSync(`${work}/message${i}`, message.data));
fs.writeFileSync(work + "/messages.json", JSON.stringify({
  topics: topics.map(([name, type]) => ({ name, type: type.replace("/", "/msg/") })),
  messages: messages.map(({ topic, time }, i) => ({ topic, time: String(time), file: `message${i}` })) }));
