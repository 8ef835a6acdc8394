#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the same posed scans in many formats, with programs that share no code with gaussmap.

usage: /usr/bin/python3 make.py SCANS OUTPUT TOOLS [POINTS]

SCANS   a directory of PCD files in the frame of the sensor, with the pose in VIEWPOINT
OUTPUT  an existing directory
TOOLS   a directory with
          laspy, python-plyfile   clones of https://github.com/laspy/laspy (2.7.0, commit fbc5b37) and
                                  https://github.com/dranjan/python-plyfile (1.1.3, commit 071e2ba)
          libE57Format            a clone of https://github.com/asmaloney/libE57Format (3.4.0, commit 21c2943), built in
                                  its folder build with cmake -DCMAKE_BUILD_TYPE=Release -DE57_BUILD_TEST=OFF
                                  -DE57_BUILD_SHARED=OFF (needs libxerces-c-dev)
          LASzip                  a clone of https://github.com/LASzip/LASzip (3.5.0, commit ac3e9e9), built in its
                                  folder build with cmake -DCMAKE_BUILD_TYPE=Release -DLASZIP_BUILD_STATIC=ON
          node_modules            npm install @mcap/core@2.2.2 @foxglove/rosmsg2-serialization@3.1.0
                                  @foxglove/rosmsg-msgs-common@3.2.3 @foxglove/wasm-zstd@1.0.1 tslib@2 (node 20)
POINTS  number of random points per scan; default: all points

Debian 12: python3-numpy 1.24.2, python3-rosbag 1.15.15, python3-sensor-msgs 1.13.1, python3-tf2-msgs 0.7.6, pcl-tools
1.13.0 (for compressed PCD files), lz4 1.9.4, zstd 1.5.4.

The files of this folder were made from the scans of `gaussmap simulate corner -o sim --scans 6 --rings 16 --columns 180
--seed 6` with POINTS = 160.

Every file has the same float32 coordinates and the same double poses, but LAS and LAZ have steps of 1 mm.

The last digits of the poses are changed, see settled(): a program that normalises a quaternion or multiplies transforms
gets the same doubles again. In the bags the pose is the product of map -> odom (a static translation),
odom -> base_link, and base_link -> lidar (a static half turn).

With POINTS, no point is nearer than 1 mm to the border of a cell of 0.1 m in the map frame. Rounding to steps of 1 mm
moves a point by at most 0.87 mm, so it moves no point to another cell.
"""
import datetime
import glob
import itertools
import json
import math
import os
import sqlite3
import subprocess
import sys
import tempfile

import numpy as np

SOURCE, OUTPUT, TOOLS = sys.argv[1:4]
POINTS = int(sys.argv[4]) if len(sys.argv) > 4 else None
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(TOOLS, "laspy"), os.path.join(TOOLS, "python-plyfile", "src"),
                os.path.join(TOOLS, "python-plyfile")]

START, STEP = 1700000000 * 10**9, 10**8  # ns
ODOM_IN_MAP = (16.0, -8.0, 0.5)
RECORD = np.dtype([(name, "<f4") for name in ("x", "y", "z", "intensity")])


def run(*words, **more):
    return subprocess.run(words, check=True, **more)


def path(*names):
    joined = os.path.join(OUTPUT, *names)
    os.makedirs(os.path.dirname(joined), exist_ok=True)
    return joined


# ---------------------------------------------------------------------------------------------------- points and poses
def read_pcd(name):
    """Returns the records and the seven numbers of VIEWPOINT."""
    def header(file):
        lines = {}
        for line in iter(file.readline, b""):
            words = line.decode().split()
            lines[words[0]] = words[1:]
            if words[0] == "DATA":
                return lines

    with open(name, "rb") as file:
        lines = header(file)
    viewpoint = [float(word) for word in lines["VIEWPOINT"]]
    with tempfile.NamedTemporaryFile(suffix=".pcd") as plain:
        if lines["DATA"] != ["binary"]:
            run("pcl_convert_pcd_ascii_binary", name, plain.name, "1", stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL)
            name = plain.name
        with open(name, "rb") as file:
            lines = header(file)
            kinds = [(f, "<%s%s" % (t.lower(), s), (int(c),)) for f, t, s, c in
                     zip(lines["FIELDS"], lines["TYPE"], lines["SIZE"], lines["COUNT"])]
            read = np.frombuffer(file.read(), np.dtype(kinds), int(lines["POINTS"][0]))
    records = np.zeros(len(read), RECORD)
    for field in RECORD.names:
        if field in read.dtype.names:
            records[field] = read[field][:, 0]
    return records[np.isfinite(read["x"] + read["y"] + read["z"])[:, 0]], viewpoint


def is_settled(q):
    squares = [c * c for c in q]
    norms = [((a + b) + c) + d for a, b, c, d in itertools.permutations(squares)]
    norms += [(a + b) + (c + d) for a, b, c, d in itertools.permutations(squares)]
    return all(math.sqrt(norm) == 1.0 for norm in norms)


def settled(viewpoint, rng):
    """Returns x y z and qw qx qy qz. The position is rounded to 2^-30 m, so a sum with ODOM_IN_MAP is exact. The
    quaternion has length 1 in floating point, whatever the order of the sum."""
    position = [round(v * 2**30) / 2**30 for v in viewpoint[:3]]
    unit = np.array(viewpoint[3:]) / math.sqrt(sum(v * v for v in viewpoint[3:]))
    q = unit
    while not is_settled(list(q)):
        q = unit + rng.integers(-2, 3, 4) * np.spacing(unit)
    return position + [float(v) for v in q]


def rotation(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def coordinates(records):
    return np.stack([records[axis].astype(float) for axis in "xyz"], 1)


def thinned(records, pose, rng):
    side, margin = 0.1, 0.001
    in_map = coordinates(records) @ rotation(*pose[3:]).T + pose[:3]
    inside = np.abs(in_map - side * np.round(in_map / side)).min(1) > margin
    chosen = rng.choice(np.flatnonzero(inside), POINTS, replace=False)
    return records[np.sort(chosen)]


def read_scans():
    rng = np.random.default_rng(1)
    scans = []
    for name in sorted(glob.glob(os.path.join(SOURCE, "*.pcd"))):
        records, viewpoint = read_pcd(name)
        pose = settled(viewpoint, rng)
        if POINTS:
            records = thinned(records, pose, rng)
            records["intensity"] = rng.random(POINTS)
        scans.append((records, pose))
    return scans


# ------------------------------------------------------------------------------------------------- one file per scan
def write_pcd(name, records, pose):
    head = ["VERSION 0.7", "FIELDS x y z intensity", "SIZE 4 4 4 4", "TYPE F F F F", "COUNT 1 1 1 1",
            "WIDTH %d" % len(records), "HEIGHT 1", "VIEWPOINT " + " ".join(map(repr, pose)),
            "POINTS %d" % len(records), "DATA binary"]
    with open(name, "wb") as file:
        file.write(("\n".join(head) + "\n").encode() + records.tobytes())


def write_bin(name, records, _):
    records.tofile(name)


def write_ply(name, records, _):
    from plyfile import PlyData, PlyElement
    PlyData([PlyElement.describe(records, "vertex")], byte_order="<").write(name)


def write_las(name, records, _):
    np.bool = np.bool_  # laspy needs the name, which numpy 1.24 does not have
    import laspy
    header = laspy.LasHeader(version="1.2", point_format=0)
    header.scales, header.offsets = np.full(3, 0.001), np.zeros(3)
    header.creation_date = datetime.date(2024, 1, 1)
    las = laspy.LasData(header)
    for axis in "xyz":
        setattr(las, axis, records[axis].astype(float))
    las.intensity = np.round(records["intensity"] * 65535.0).astype(np.uint16)
    assert max(abs(las[axis] - records[axis]).max() for axis in "xyz") < 0.0005001
    las.write(name)


# ------------------------------------------------------------------------------------------------ one file of all scans
def compiled(source, *words):
    program = os.path.join(WORK, source + ".program")
    run("g++", "-std=c++17", "-O1", os.path.join(HERE, source), "-o", program, *words)
    return program


def write_e57(scans):
    library = os.path.join(TOOLS, "libE57Format")
    program = compiled("make_e57.cpp", "-I" + library + "/include", "-I" + library + "/build",
                       library + "/build/libE57Format.a", "-lxerces-c", "-lpthread")
    listed = os.path.join(WORK, "scans.txt")
    with open(listed, "w") as file:
        for i, (_, pose) in enumerate(scans):
            print(path("bin", "%06d.bin" % i), *map(repr, pose), file=file)
    run(program, listed, path("scans.e57"))


def write_laz(count):
    library = os.path.join(TOOLS, "LASzip")
    program = compiled("make_laz.cpp", "-I" + library + "/dll", "-I" + library + "/include/laszip",
                       library + "/build/lib/liblaszip.a")
    for i in range(count):
        run(program, path("las", "%06d.las" % i), path("laz", "%06d.laz" % i))


def transforms_of(pose):
    """Returns odom -> base_link as x y z and qx qy qz qw."""
    w, x, y, z = pose[3:]
    position = [value - origin for value, origin in zip(pose[:3], ODOM_IN_MAP)]
    assert [value + origin for value, origin in zip(position, ODOM_IN_MAP)] == pose[:3]
    return position, [-w, -z, y, x]  # q * conj(i), so the product with i is q again


STATIC = [("map", "odom", ODOM_IN_MAP, (0.0, 0.0, 0.0, 1.0)),
          ("base_link", "lidar", (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))]


def write_ros1(scans):
    import rosbag
    from genpy import Time
    from geometry_msgs.msg import TransformStamped
    from sensor_msgs.msg import PointCloud2, PointField
    from tf2_msgs.msg import TFMessage

    def stamp(ns):
        return Time(ns // 10**9, ns % 10**9)

    def transform(ns, parent, child, position, q):
        message = TransformStamped(child_frame_id=child)
        message.header.stamp, message.header.frame_id = stamp(ns), parent
        t, r = message.transform.translation, message.transform.rotation
        (t.x, t.y, t.z), (r.x, r.y, r.z, r.w) = position, q
        return message

    with rosbag.Bag(path("scans.bag"), "w") as bag:
        bag.write("/tf_static", TFMessage([transform(START, *static) for static in STATIC]), stamp(START))
        for i, (records, pose) in enumerate(scans):
            ns = START + i * STEP
            bag.write("/tf", TFMessage([transform(ns, "odom", "base_link", *transforms_of(pose))]), stamp(ns))
            cloud = PointCloud2(height=1, width=len(records), point_step=16, row_step=16 * len(records), is_dense=True,
                                data=records.tobytes())
            cloud.header.seq, cloud.header.stamp, cloud.header.frame_id = i, stamp(ns), "lidar"
            cloud.fields = [PointField(name, 4 * k, PointField.FLOAT32, 1) for k, name in enumerate(RECORD.names)]
            bag.write("/points", cloud, stamp(ns + 30 * 10**6))


def write_mcap(scans):
    """Writes the MCAP files. Returns the topics and messages, for the database."""
    description = {"start": START, "step": STEP, "static": STATIC,
                   "scans": [{"file": os.path.abspath(path("bin", "%06d.bin" % i)), "transform": transforms_of(pose)}
                             for i, (_, pose) in enumerate(scans)]}
    with open(os.path.join(WORK, "description.json"), "w") as file:
        json.dump(description, file)
    run("node", os.path.join(HERE, "make_mcap.mjs"), os.path.abspath(TOOLS), os.path.join(WORK, "description.json"),
        os.path.abspath(OUTPUT), WORK)
    with open(os.path.join(WORK, "messages.json")) as file:
        return json.load(file)


TABLES = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY,metadata_version INTEGER NOT NULL,metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT NOT NULL,
offered_qos_profiles TEXT NOT NULL,type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY,topic_type TEXT NOT NULL,encoding TEXT NOT NULL,
encoded_message_definition TEXT NOT NULL,type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
INSERT INTO schema VALUES(4, 'jazzy');
"""


def write_db3(recording):
    name = path("rosbag2", "rosbag2_0.db3")
    if os.path.exists(name):
        os.remove(name)
    database = sqlite3.connect(name)
    database.executescript("PRAGMA page_size = 1024;" + TABLES if POINTS else TABLES)
    for i, topic in enumerate(recording["topics"]):
        database.execute("INSERT INTO topics VALUES(?,?,?,'cdr','','')", (i + 1, topic["name"], topic["type"]))
    for message in recording["messages"]:
        with open(os.path.join(WORK, message["file"]), "rb") as file:
            database.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)",
                             (message["topic"] + 1, int(message["time"]), file.read()))
    database.commit()
    database.close()
    with open(path("rosbag2", "metadata.yaml"), "w") as file:
        file.write("rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: sqlite3\n"
                   "  relative_file_paths:\n    - rosbag2_0.db3\n")


# ---------------------------------------------------------------------------------------------------------- pose files
def write_poses(scans):
    with open(path("poses.tum"), "w") as tum, open(path("poses_kitti.txt"), "w") as kitti:
        for i, (_, pose) in enumerate(scans):
            ns = START + i * STEP
            print("%d.%09d" % (ns // 10**9, ns % 10**9), *map(repr, pose[:3] + pose[4:] + pose[3:4]), file=tum)
            print(*(repr(float(v)) for v in np.c_[rotation(*pose[3:]), pose[:3]].ravel()), file=kitti)


with tempfile.TemporaryDirectory() as WORK:
    all_scans = read_scans()
    write_poses(all_scans)
    for kind, write in (("pcd", write_pcd), ("bin", write_bin), ("ply", write_ply), ("las", write_las)):
        for index, (points, sensor) in enumerate(all_scans):
            write(path(kind, "%06d.%s" % (index, kind)), points, sensor)
    os.makedirs(os.path.join(OUTPUT, "laz"), exist_ok=True)
    write_laz(len(all_scans))
    write_e57(all_scans)
    write_ros1(all_scans)
    write_db3(write_mcap(all_scans))
