// SPDX-License-Identifier: BSD-3-Clause
// Writes messages.txt: messages of ROS 1 and ROS 2 in all encodings, with the values that went into them.
// In a scratch folder: npm install @foxglove/rosmsg2-serialization@3.1.0 @foxglove/rosmsg-serialization@2.0.4
//   @foxglove/rosmsg-msgs-common@3.2.3 @foxglove/cdr@3.5.0 tslib; cp make.mjs there; node make.mjs > messages.txt
// Little-endian CDR comes from rosmsg2-serialization, ROS 1 from rosmsg-serialization. The other kinds of CDR are
// written value by value with @foxglove/cdr.
import { createRequire } from "module";
const require = createRequire(import.meta.url);
const { MessageWriter: Writer2 } = require("@foxglove/rosmsg2-serialization");
const { MessageWriter: Writer1 } = require("@foxglove/rosmsg-serialization");
const { ros1, ros2humble } = require("@foxglove/rosmsg-msgs-common");
const { CdrWriter, EncapsulationKind } = require("@foxglove/cdr");

// sensor_msgs/PointCloud is not among the definitions of ROS 2 there.
const field = (name, type, extra = {}) => ({ name, type, isArray: false, isComplex: false, ...extra });
const old = {
  "sensor_msgs/PointCloud": { name: "sensor_msgs/PointCloud", definitions: [
    field("header", "std_msgs/Header", { isComplex: true }),
    field("points", "geometry_msgs/Point32", { isComplex: true, isArray: true }),
    field("channels", "sensor_msgs/ChannelFloat32", { isComplex: true, isArray: true })] },
  "geometry_msgs/Point32": { name: "geometry_msgs/Point32", definitions: [
    field("x", "float32"), field("y", "float32"), field("z", "float32")] },
  "sensor_msgs/ChannelFloat32": { name: "sensor_msgs/ChannelFloat32", definitions: [
    field("name", "string"), field("values", "float32", { isArray: true })] },
};
const ros2 = { ...old, ...ros2humble };
function closure(all, type, found = new Map()) {
  if (found.has(type)) return found;
  found.set(type, all[type]);
  for (const f of all[type].definitions) if (f.isComplex) closure(all, f.type, found);
  return found;
}
function definitionsOf(all, type) {
  return [...closure(all, type).values()].map((d, i) => (i === 0 ? { definitions: d.definitions } : d));
}

function writeCdr(type, value, kind) {
  const is2 = kind === EncapsulationKind.RTPS_CDR2_LE || kind === EncapsulationKind.RTPS_CDR2_BE;
  const writer = new CdrWriter({ kind, size: 1 << 16 });
  const one = (f, v) => {
    if (f.isComplex) return all(f.type, v);
    if (f.type === "time") { writer.int32(v.sec); return writer.uint32(v.nanosec); }
    return f.type === "bool" ? writer.uint8(v ? 1 : 0) : writer[f.type](v);
  };
  const all = (name, object) => {
    for (const f of ros2[name].definitions) {
      if (f.isConstant) continue;
      const v = object[f.name];
      if (!f.isArray) { one(f, v); continue; }
      if (f.arrayLength !== undefined) { for (const x of v) one(f, x); continue; }
      if (!is2 || !f.isComplex) { writer.uint32(v.length); for (const x of v) one(f, x); continue; }
      // An array of structures has its size in bytes in front: written as 0 and corrected.
      writer.uint32(0);
      const at = writer.size;
      writer.uint32(v.length);
      for (const x of v) one(f, x);
      new DataView(writer.buffer).setUint32(at - 4, writer.size - at, kind === EncapsulationKind.RTPS_CDR2_LE);
    }
  };
  all(type, value);
  return writer.data;
}

const hex = (bytes) => Buffer.from(bytes).toString("hex");
function emit(name, type, value, expected) {
  const encodings = {
    ros1: () => new Writer1(definitionsOf({ ...old, ...ros1 }, type)).writeMessage(asRos1(value)),
    cdr_le: () => new Writer2(definitionsOf(ros2, type)).writeMessage(value),
    cdr_be: () => writeCdr(type, value, EncapsulationKind.CDR_BE),
    cdr2_le: () => writeCdr(type, value, EncapsulationKind.RTPS_CDR2_LE),
    cdr2_be: () => writeCdr(type, value, EncapsulationKind.RTPS_CDR2_BE),
  };
  if (hex(writeCdr(type, value, EncapsulationKind.CDR_LE)) !== hex(encodings.cdr_le())) throw new Error(type);
  for (const [encoding, write] of Object.entries(encodings))
    console.log(`message ${name} ${type} ${encoding} ${hex(write())}`);
  for (const [key, values] of expected) console.log(`expect ${key} ${[].concat(values).join(" ")}`);
  console.log("end");
}
function asRos1(value) {
  if (Array.isArray(value)) return value.map(asRos1);
  if (value === null || typeof value !== "object" || ArrayBuffer.isView(value)) return value;
  if ("nanosec" in value) return { sec: value.sec, nsec: value.nanosec };
  const copy = Object.fromEntries(Object.entries(value).map(([k, v]) => [k, asRos1(v)]));
  return "frame_id" in copy ? { seq: 7, ...copy } : copy;
}

let state = 12345;
const random = () => (state = (Math.imul(state, 1103515245) + 12345) >>> 0) / 2 ** 32;
const header = (frame, sec, nanosec) => ({ stamp: { sec, nanosec }, frame_id: frame });
const heading = (h) => [["stamp", `${h.stamp.sec}.${String(h.stamp.nanosec).padStart(9, "0")}`],
                        ["frame", h.frame_id || "-"]];

// datatype: size, range of integers
const kinds = { 1: ["Int8", 1], 2: ["Uint8", 1], 3: ["Int16", 2], 4: ["Uint16", 2], 5: ["Int32", 4], 6: ["Uint32", 4],
                7: ["Float32", 4], 8: ["Float64", 8] };
function cloud(name, frame, width, height, fields, pointStep, rowStep, bigEndian) {
  const h = header(frame, 1700000000, 100000000);
  const data = new Uint8Array(rowStep * height).fill(0xaa);
  const view = new DataView(data.buffer);
  const columns = new Map();
  for (const f of fields) {
    const [kind, size] = kinds[f.datatype];
    for (let e = 0; e < Math.max(f.count, 1); ++e) {
      const values = [];
      for (let i = 0; i < width * height; ++i) {
        const place = Math.floor(i / width) * rowStep + (i % width) * pointStep + f.offset + e * size;
        const raw = f.datatype >= 7 ? (i === 3 ? NaN : 200 * random() - 100) : Math.floor(2 ** 33 * random());
        view[`set${kind}`](place, raw, !bigEndian);
        values.push(view[`get${kind}`](place, !bigEndian));
      }
      const key = ["t", "timestamp", "offset_time"].includes(f.name) ? "time" : f.name;
      columns.set(f.count > 1 ? `${key}[${e}]` : key, values);
    }
  }
  emit(name, "sensor_msgs/PointCloud2",
       { header: h, height, width, fields, is_bigendian: bigEndian, point_step: pointStep, row_step: rowStep, data,
         is_dense: false },
       [...heading(h), ["points", width * height], ["columns", height > 1 ? width : 0], ...columns]);
}
const point = (name, offset, datatype, count = 1) => ({ name, offset, datatype, count });
const xyz = [point("x", 0, 7), point("y", 4, 7), point("z", 8, 7)];
cloud("velodyne", "velodyne", 7, 1, [...xyz, point("intensity", 16, 7), point("ring", 20, 4), point("time", 22, 7)], 26,
      182, false);
cloud("ouster", "os_sensor", 6, 4, [...xyz, point("intensity", 16, 7), point("t", 20, 6), point("reflectivity", 24, 4),
      point("ring", 26, 2), point("range", 28, 6)], 48, 300, false);
cloud("all_types", "", 5, 2, [point("x", 1, 8), point("z", 9, 8), point("y", 17, 8), point("a", 25, 1),
      point("b", 26, 2), point("c", 27, 3, 2), point("d", 31, 4), point("e", 33, 5), point("f", 37, 6),
      point("timestamp", 41, 8), point("g", 49, 7, 3)], 61, 305, false);
cloud("big_endian", "/lidar", 3, 2, [...xyz, point("offset_time", 12, 6), point("normal", 16, 8, 3)], 40, 120, true);
cloud("empty", "lidar", 0, 1, xyz, 16, 0, false);

function laser(name, frame, ranges, intensities, timeIncrement) {
  const h = header(frame, 1326899528, 425511400);
  const f = Math.fround;
  const scan = { header: h, angle_min: f(-1.57), angle_max: f(1.57), angle_increment: f(0.3), time_increment: f(timeIncrement),
                 scan_time: f(0.1), range_min: f(0.5), range_max: f(30), ranges: Float32Array.from(ranges),
                 intensities: Float32Array.from(intensities) };
  const good = [...scan.ranges].map((r) => Number.isFinite(r) && r >= scan.range_min && r <= scan.range_max);
  const angle = (i) => scan.angle_min + i * scan.angle_increment;
  const expected = [...heading(h), ["points", ranges.length], ["columns", 0],
    ["x", [...scan.ranges].map((r, i) => (good[i] ? r * Math.cos(angle(i)) : NaN))],
    ["y", [...scan.ranges].map((r, i) => (good[i] ? r * Math.sin(angle(i)) : NaN))],
    ["z", good.map((g) => (g ? 0 : NaN))]];
  if (intensities.length > 0) expected.push(["intensity", [...scan.intensities]]);
  if (timeIncrement !== 0) expected.push(["time", [...scan.ranges].map((r, i) => i * scan.time_increment)]);
  emit(name, "sensor_msgs/LaserScan", scan, expected);
}
laser("hokuyo", "laser", [1, 2.5, 0.1, 31, Infinity, NaN, -Infinity, 30, 0.5, -1, 7], [...Array(11).keys()], 0.0001);
laser("no_intensities", "base_scan_link", [3, 4, 5], [], 0);

{
  const h = header("cam", 12, 5);
  const points = [[1, 2, 3], [-1.5, 0.25, 1e6], [NaN, 0, 1]].map(([x, y, z]) => ({ x, y, z }));
  emit("old_cloud", "sensor_msgs/PointCloud",
       { header: h, points, channels: [{ name: "intensity", values: Float32Array.of(5, 6, 7) },
                                       { name: "u", values: Float32Array.of(0.5, -0.5, 2) }] },
       [...heading(h), ["points", 3], ["columns", 0], ...["x", "y", "z"].map((a) => [a, points.map((p) => p[a])]),
        ["intensity", [5, 6, 7]], ["u", [0.5, -0.5, 2]]]);
}

function pose() {
  const t = { x: 100 * random(), y: -50 * random(), z: random() };
  const q = [random() - 0.5, random() - 0.5, random() - 0.5, random() + 0.1];
  const norm = Math.hypot(...q);
  return { t, q: { x: q[0] / norm, y: q[1] / norm, z: q[2] / norm, w: q[3] / norm } };
}
const row = (h, child, { t, q }) => ["pose", [heading(h)[0][1], h.frame_id || "-", child || "-", t.x, t.y, t.z, q.x, q.y,
                                              q.z, q.w]];
const covariance = () => Float64Array.from({ length: 36 }, random);
{
  const rows = [["odom", "base_link"], ["/map", "/odom"], ["base_link", "a"], ["b", ""]].map(([parent, child], i) =>
    ({ h: header(parent, 1700000000 + i, 123456789), child, p: pose() }));
  emit("tf", "tf2_msgs/TFMessage",
       { transforms: rows.map(({ h, child, p }) => ({ header: h, child_frame_id: child,
                                                      transform: { translation: p.t, rotation: p.q } })) },
       rows.map(({ h, child, p }) => row(h, child, p)));
  emit("no_tf", "tf2_msgs/TFMessage", { transforms: [] }, []);
}
for (const frame of ["odom", "world_"]) {
  const h = header(frame, 1700000001, 999999999), p = pose(), q = pose();
  const twist = { twist: { linear: p.t, angular: q.t }, covariance: covariance() };
  const as_pose = { position: p.t, orientation: p.q };
  emit("odometry", "nav_msgs/Odometry",
       { header: h, child_frame_id: "base_footprint", pose: { pose: as_pose, covariance: covariance() }, twist },
       [row(h, "base_footprint", p)]);
  emit("pose", "geometry_msgs/PoseStamped", { header: h, pose: as_pose }, [row(h, "", p)]);
  emit("pose_with_covariance", "geometry_msgs/PoseWithCovarianceStamped",
       { header: h, pose: { pose: as_pose, covariance: covariance() } }, [row(h, "", p)]);
  emit("transform", "geometry_msgs/TransformStamped",
       { header: h, child_frame_id: "lidar", transform: { translation: p.t, rotation: p.q } }, [row(h, "lidar", p)]);
  const h2 = header("", 1700000002, 0);
  emit("path", "nav_msgs/Path",
       { header: h, poses: [{ header: h, pose: as_pose }, { header: h2, pose: { position: q.t, orientation: q.q } }] },
       [row(h, "", p), row({ ...h2, frame_id: frame }, "", q)]);
}
