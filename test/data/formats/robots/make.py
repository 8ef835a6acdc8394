#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes recordings of robots, each with the topics and frames of a common kind of robot, and the truth: the same scans
as PCD files (their VIEWPOINT is the identity), and their exact poses as TUM files.

A robot drives through a room with constant velocity, so the exact pose between two messages is the interpolated one.
Ranges have no noise. The walls are in the middle of cells of 0.2 m, so rounding moves no point into another cell.

MCAP and the messages of ROS 2: write.mjs (Node 20; npm install @mcap/core@2.2.2 @foxglove/wasm-zstd@1.0.1
@foxglove/rosmsg2-serialization@3.1.0 @foxglove/rosmsg-msgs-common@3.2.3 tslib; lz4 1.9.4).
Debian 12: python3-numpy 1.24.2, python3-rosbag 1.15.15 and python3-{sensor,geometry,nav,tf2}-msgs, sqlite3 3.40.1 of
Python, zstd 1.5.4.
Usage: cd robots; ./make.py FOLDER_WITH_node_modules
"""
import base64
import json
import math
import os
import shutil
import sqlite3
import subprocess
import sys

import numpy as np

SECOND, MS = 10**9, 10**6
START = 1700000000 * SECOND
SCANS = 5

# ---- The world ----
ROOM = ((0.1, 0.1, 0.1), (12.1, 9.1, 3.1))
BOXES = (((2.1, 1.1, 0.1), (3.5, 2.3, 1.5)), ((6.5, 5.5, 0.1), (7.3, 8.1, 2.1)), ((9.1, 0.5, 0.1), (10.1, 3.1, 0.9)))


def turn(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array({"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
                     "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis])


def pose(rotation, translation):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, translation
    return matrix


def inverse(matrix):
    return np.linalg.inv(matrix)


def quaternion(rotation):
    """x y z w"""
    k = np.array([[rotation[i][j] for j in range(3)] for i in range(3)])
    symmetric = np.array([
        [k[0, 0] - k[1, 1] - k[2, 2], k[1, 0] + k[0, 1], k[2, 0] + k[0, 2], k[2, 1] - k[1, 2]],
        [k[1, 0] + k[0, 1], k[1, 1] - k[0, 0] - k[2, 2], k[2, 1] + k[1, 2], k[0, 2] - k[2, 0]],
        [k[2, 0] + k[0, 2], k[2, 1] + k[1, 2], k[2, 2] - k[0, 0] - k[1, 1], k[1, 0] - k[0, 1]],
        [k[2, 1] - k[1, 2], k[0, 2] - k[2, 0], k[1, 0] - k[0, 1], k[0, 0] + k[1, 1] + k[2, 2]]]) / 3
    values, vectors = np.linalg.eigh(symmetric)
    return [float(v) for v in vectors[:, np.argmax(values)]]


def cast(origin, directions):
    with np.errstate(divide="ignore", invalid="ignore"):
        low, high = (np.array(corner) for corner in ROOM)
        best = np.where(directions > 0, (high - origin) / directions,
                        np.where(directions < 0, (low - origin) / directions, np.inf)).min(axis=1)
        for corner, other in BOXES:
            a, b = (np.array(corner) - origin) / directions, (np.array(other) - origin) / directions
            near, far = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
            best = np.where((near > 0) & (near < far) & (near < best), near, best)
    return best


def scan(sensor, directions):
    return (directions * cast(sensor[:3, 3], directions @ sensor[:3, :3].T)[:, None]).astype("<f4")


def moved(matrix, points):
    return (points.astype(float) @ matrix[:3, :3].T + matrix[:3, 3]).astype("<f4")


# ---- The robot ----
MAP_ODOM = pose(turn("z", 0.3), [1.5, 2.0, 0.0])
LIDAR = pose(turn("z", 0.4) @ turn("y", 0.15) @ turn("x", -0.1), [0.4, -0.1, 0.9])
REAR = pose(turn("z", math.pi - 0.1), [-0.5, 0.1, 0.8])
LASER = pose(turn("z", -0.35), [0.25, 0.1, 0.3])
CAMERA = pose(turn("y", 0.1), [0.3, 0.05, 0.6])
OPTICAL = pose(turn("z", -math.pi / 2) @ turn("x", -math.pi / 2), [0.0, 0.01, 0.0])

TIMES = [START + 33 * MS + i * 100 * MS for i in range(SCANS)]
REAR_TIMES = [time + 30 * MS for time in TIMES[:2]]
TICKS = [START - 150 * MS + i * 50 * MS for i in range(15)]  # of odometry and tf


def robot(time):
    t = (time - START) / SECOND
    return pose(turn("z", -0.2 + 0.8 * t), [2.2 + 6.0 * t, 4.0 + 1.1 * t, 0.15])


def robot_in_odom(time):
    return inverse(MAP_ODOM) @ robot(time)


def lidar_directions(rings, columns):
    return np.array([[math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)]
                     for a in np.arange(columns) * 2 * math.pi / columns
                     for e in np.radians(np.linspace(-20, 15, rings))])


LIDAR_DIRECTIONS = lidar_directions(4, 20)
CAMERA_DIRECTIONS = np.array([[(u - 5.5) / 8, (v - 3.5) / 8, 1.0] for v in range(8) for u in range(12)])
BEAMS = 91
FIRST, STEP = float(np.float32(-math.pi / 2)), float(np.float32(math.pi / (BEAMS - 1)))
BEAM_DIRECTIONS = np.array([[math.cos(FIRST + i * STEP), math.sin(FIRST + i * STEP), 0] for i in range(BEAMS)])

FRONT_SCANS = [scan(robot(time) @ LIDAR, LIDAR_DIRECTIONS) for time in TIMES]
REAR_SCANS = [scan(robot(time) @ REAR, LIDAR_DIRECTIONS) for time in REAR_TIMES]
DEPTH_SCANS = [scan(robot(time) @ CAMERA @ OPTICAL, CAMERA_DIRECTIONS) for time in TIMES]
LASER_RANGES = [cast((robot(time) @ LASER)[:3, 3], BEAM_DIRECTIONS @ (robot(time) @ LASER)[:3, :3].T).astype("<f4")
                for time in TIMES]


# ---- Messages: [topic, type, time of recording, value] ----
def header(time, frame):
    return {"stamp": {"sec": time // SECOND, "nanosec": time % SECOND}, "frame_id": frame}


def vector(values):
    return dict(zip("xyz", (float(v) for v in values)))


def rotation(matrix):
    return dict(zip("xyzw", quaternion(matrix[:3, :3])))


def pose_value(matrix):
    return {"position": vector(matrix[:3, 3]), "orientation": rotation(matrix)}


def transforms(topic, logged, *items):
    """Items are (time, parent, child, matrix)."""
    return [topic, "tf2_msgs/TFMessage", str(logged), {"transforms": [
        {"header": header(time, parent), "child_frame_id": child,
         "transform": {"translation": vector(matrix[:3, 3]), "rotation": rotation(matrix)}}
        for time, parent, child, matrix in items]}]


def odometry(topic, logged, time, parent, child, matrix):
    still = {"linear": vector([0, 0, 0]), "angular": vector([0, 0, 0])}
    return [topic, "nav_msgs/Odometry", str(logged),
            {"header": header(time, parent), "child_frame_id": child,
             "pose": {"pose": pose_value(matrix), "covariance": [0.0] * 36},
             "twist": {"twist": still, "covariance": [0.0] * 36}}]


def cloud(topic, logged, time, frame, points, width=None):
    width = width or len(points)
    fields = [{"name": name, "offset": 4 * i, "datatype": 7, "count": 1} for i, name in enumerate("xyz")]
    return [topic, "sensor_msgs/PointCloud2", str(logged),
            {"header": header(time, frame), "height": len(points) // width, "width": width, "fields": fields,
             "is_bigendian": False, "point_step": 12, "row_step": 12 * width,
             "data": {"base64": base64.b64encode(points.astype("<f4").tobytes()).decode()}, "is_dense": True}]


def laser(topic, logged, time, frame, ranges):
    return [topic, "sensor_msgs/LaserScan", str(logged),
            {"header": header(time, frame), "angle_min": FIRST, "angle_max": FIRST + STEP * (BEAMS - 1),
             "angle_increment": STEP, "time_increment": 0.0, "scan_time": 0.1, "range_min": 0.1, "range_max": 30.0,
             "ranges": [float(r) for r in ranges], "intensities": []}]


# ---- Parts of recordings ----
def lidar(topic="/velodyne_points", frame="velodyne", scans=FRONT_SCANS, times=TIMES, stamp=lambda time: time,
          late=10 * MS):
    return [cloud(topic, time + late, stamp(time), frame, points) for time, points in zip(times, scans)]


def odom_tf(topic="/tf", prefix="", child="base_link", ticks=TICKS, late=5 * MS):
    return [transforms(topic, time + late, (time, prefix + "odom", prefix + child, robot_in_odom(time)))
            for time in ticks]


def map_tf(topic="/tf", prefix="", ticks=TICKS[::2], late=5 * MS):
    """As AMCL does: the time is a little in the future."""
    return [transforms(topic, time + late, (time + 20 * MS, prefix + "map", prefix + "odom", MAP_ODOM))
            for time in ticks]


def static_tf(*links, topic="/tf_static"):
    return [transforms(topic, TICKS[0] - MS, *[(START - 60 * SECOND, *link) for link in links])]


def odom(topic="/odom", child="base_link"):
    return [odometry(topic, time + 5 * MS, time, "odom", child, robot_in_odom(time)) for time in TICKS]


ON_ROBOT = static_tf(("base_link", "velodyne", LIDAR))
WITH_TF = lidar() + odom_tf() + map_tf() + ON_ROBOT


def slam_poses():
    return [["/slam/pose", "geometry_msgs/PoseStamped", str(time + 60 * MS),
             {"header": header(time, "map"), "pose": pose_value(robot(time))}] for time in TIMES]


def fast_lio():
    """Points and poses in the frame of the first scan."""
    first = robot(TIMES[0]) @ LIDAR
    messages = []
    for time, points in zip(TIMES, FRONT_SCANS):
        place = inverse(first) @ robot(time) @ LIDAR
        messages += [cloud("/cloud_registered", time + 20 * MS, time, "camera_init", moved(place, points)),
                     odometry("/Odometry", time + 20 * MS, time, "camera_init", "body", place)]
    return messages


def clock_reset():
    """After three scans, the simulated time starts again: the same times in the headers, other places."""
    begin = 10 * SECOND
    messages = []
    for first, last, shift in ((0, 3, START - begin), (3, SCANS, START + 300 * MS - begin)):
        from_time, to_time = TIMES[first] - 60 * MS, TIMES[last - 1] + 40 * MS
        messages += lidar(scans=FRONT_SCANS[first:last], times=TIMES[first:last], stamp=lambda time, s=shift: time - s,
                          late=5 * MS)
        messages += [transforms("/tf", time + 5 * MS, (time - shift, "map", "base_link", robot(time)))
                     for time in range(from_time, to_time + 1, 20 * MS)]
    return messages + ON_ROBOT


RECORDINGS = {
    "tf": WITH_TF,
    "odometry": lidar() + odom() + ON_ROBOT,
    "odometry_only": lidar() + odom(),
    "slam_pose": lidar() + slam_poses() + ON_ROBOT,
    "two_lidars": WITH_TF + static_tf(("base_link", "velodyne_rear", REAR))
    + lidar("/rear/points", "velodyne_rear", REAR_SCANS, REAR_TIMES),
    "laser": [laser("/scan", time + 10 * MS, time, "laser", ranges) for time, ranges in zip(TIMES, LASER_RANGES)]
    + odom_tf(child="base_footprint")
    + static_tf(("base_footprint", "base_link", np.eye(4)), ("base_link", "laser", LASER)),
    "fast_lio": fast_lio(),
    "no_poses": lidar(),
    "late_tf": lidar() + odom_tf(ticks=TICKS[6:]) + map_tf(ticks=TICKS[6::2]) + ON_ROBOT,
    "clock_reset": clock_reset(),
    "zero_times": [cloud("/velodyne_points", time, 0, "velodyne", points) for time, points in zip(TIMES, FRONT_SCANS)]
    + odom_tf() + map_tf() + ON_ROBOT,
    "boot_clock": [cloud("/velodyne_points", time, time - START + 100 * SECOND, "velodyne", points)
                   for time, points in zip(TIMES, FRONT_SCANS)] + odom_tf(late=0) + map_tf() + ON_ROBOT,
    "unfinished": WITH_TF,
    "depth": [cloud("/camera/depth/points", time + 10 * MS, time, "camera_depth_optical_frame", points, 12)
              for time, points in zip(TIMES, DEPTH_SCANS)] + odom_tf() + map_tf()
    + static_tf(("base_link", "camera_link", CAMERA), ("camera_link", "camera_depth_optical_frame", OPTICAL)),
    "delayed_tf": lidar() + odom_tf(late=300 * MS) + map_tf(late=500 * MS) + ON_ROBOT,
    "slow_tf": lidar() + odom_tf(ticks=[START - 100 * MS + i * 400 * MS for i in range(3)]) + ON_ROBOT,
    "without_lidar_frame": lidar() + odom_tf() + map_tf(),
    "namespace": lidar("/robot1/points", "robot1/velodyne") + odom_tf("/robot1/tf", "robot1/")
    + map_tf("/robot1/tf", "robot1/")
    + static_tf(("robot1/base_link", "robot1/velodyne", LIDAR), topic="/robot1/tf_static")
    + [odometry("/robot1/odom", time + 5 * MS, time, "robot1/odom", "robot1/base_link", robot_in_odom(time))
       for time in TICKS],
}
COMPRESSIONS = {"laser": "none", "slow_tf": "lz4"}  # others: zstd
SPLIT = TIMES[2] + 50 * MS  # time of recording


def ordered(messages):
    return sorted(messages, key=lambda message: int(message[2]))


# ---- Writers ----
def write_mcaps(modules):
    recordings = [{"name": name + ".mcap", "compression": COMPRESSIONS.get(name, "zstd"),
                   "chunk": 1200 if name == "unfinished" else 9000, "finished": name != "unfinished",
                   "messages": ordered(messages)} for name, messages in RECORDINGS.items()]
    recordings.append({"name": "messages.cdr.json", "messages": ordered(WITH_TF)})
    os.makedirs("split", exist_ok=True)
    first = sum(int(message[2]) < SPLIT for message in WITH_TF)
    for part, some in enumerate((ordered(WITH_TF)[:first], ordered(WITH_TF)[first:])):
        recordings.append({"name": "split/drive_%d.mcap" % part, "compression": "zstd", "chunk": 9000, "finished": True,
                           "messages": some})
    with open("recordings.json", "w") as out:
        json.dump(recordings, out)
    subprocess.run(["node", os.path.join(os.path.dirname(os.path.abspath(__file__)), "write.mjs"), modules,
                    "recordings.json"], check=True)
    os.remove("recordings.json")
    with open("unfinished.mcap", "rb") as file:
        data = file.read()
    with open("unfinished.mcap", "wb") as file:
        file.write(data[:len(data) * 9 // 10])


TABLES = """PRAGMA page_size = 1024;
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


def write_database(name, messages):
    database = sqlite3.connect(name)
    database.executescript(TABLES)
    topics = {}
    for topic, kind, time, data in messages:
        if topic not in topics:
            topics[topic] = len(topics) + 1
            database.execute("INSERT INTO topics VALUES(?,?,?,'cdr','','')", (topics[topic], topic, kind))
        database.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)",
                         (topics[topic], int(time), base64.b64decode(data)))
    database.commit()
    database.close()


def write_folders():
    """packed: two databases, each compressed as a file. split: two MCAP files. tf_static is only in the first."""
    with open("messages.cdr.json") as file:
        messages = json.load(file)
    os.remove("messages.cdr.json")
    shutil.rmtree("packed", ignore_errors=True)
    os.mkdir("packed")
    for name, is_part in (("drive_0.db3", lambda m: int(m[2]) < SPLIT), ("drive_1.db3", lambda m: int(m[2]) >= SPLIT)):
        write_database(name, [message for message in messages if is_part(message)])
        subprocess.run(["zstd", "-q", "-19", "--rm", name, "-o", "packed/" + name + ".zstd"], check=True)
    write_metadata("packed", "sqlite3", ["drive_0.db3.zstd", "drive_1.db3.zstd"],
                   ["  compression_format: zstd", "  compression_mode: FILE"])
    write_metadata("split", "mcap", ["drive_0.mcap", "drive_1.mcap"])


def write_metadata(folder, storage, names, more=()):
    lines = ["rosbag2_bagfile_information:", "  version: 5", "  storage_identifier: " + storage, *more,
             "  relative_file_paths:"] + ["    - " + name for name in names]
    with open(folder + "/metadata.yaml", "w") as out:
        out.write("\n".join(lines) + "\n")


def write_ros1():
    """All frames begin with a slash, as in old robots."""
    import rosbag
    from genpy import Time
    from geometry_msgs.msg import TransformStamped
    from sensor_msgs.msg import PointCloud2, PointField
    from tf2_msgs.msg import TFMessage

    def filled(message, value):
        for key, one in value.items():
            if key == "stamp":
                message.stamp = Time(one["sec"], one["nanosec"])
            elif key in ("frame_id", "child_frame_id"):
                setattr(message, key, "/" + one)
            elif key == "fields":
                message.fields = [PointField(**field) for field in one]
            elif key == "transforms":
                message.transforms = [filled(TransformStamped(), transform) for transform in one]
            elif isinstance(one, dict) and "base64" in one:
                setattr(message, key, base64.b64decode(one["base64"]))
            elif isinstance(one, dict):
                filled(getattr(message, key), one)
            else:
                setattr(message, key, one)
        return message

    types = {"sensor_msgs/PointCloud2": PointCloud2, "tf2_msgs/TFMessage": TFMessage}
    with rosbag.Bag("slashes.bag", "w", compression="bz2") as bag:
        for topic, kind, time, value in ordered(WITH_TF):
            bag.write(topic, filled(types[kind](), value), Time(int(time) // SECOND, int(time) % SECOND))


# ---- The truth ----
def write_pcds(folder, times, scans, width=None):
    os.makedirs(folder, exist_ok=True)
    for time, points in zip(times, scans):
        columns = width or len(points)
        with open("%s/%d.%09d.pcd" % (folder, time // SECOND, time % SECOND), "wb") as out:
            out.write(("VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT %d\n"
                       "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA binary\n"
                       % (columns, len(points) // columns, len(points))).encode())
            out.write(points.astype("<f4").tobytes())


def write_poses(name, times, pose_at):
    with open(name, "w") as out:
        for time in times:
            matrix = pose_at(time)
            out.write("%d.%09d %s\n" % (time // SECOND, time % SECOND, " ".join(
                repr(float(v)) for v in list(matrix[:3, 3]) + quaternion(matrix[:3, :3]))))


def write_truth():
    shutil.rmtree("truth", ignore_errors=True)
    write_pcds("truth/lidar", TIMES, FRONT_SCANS)
    write_pcds("truth/rear", REAR_TIMES, REAR_SCANS)
    write_pcds("truth/depth", TIMES, DEPTH_SCANS, 12)
    write_pcds("truth/laser", TIMES, [BEAM_DIRECTIONS * ranges[:, None] for ranges in LASER_RANGES])
    write_poses("truth/lidar.tum", TIMES, lambda time: robot(time) @ LIDAR)
    write_poses("truth/robot.tum", TIMES, robot)
    write_poses("truth/lidar_in_odom.tum", TIMES, lambda time: robot_in_odom(time) @ LIDAR)
    first = robot(TIMES[0]) @ LIDAR
    write_poses("truth/lidar_from_first.tum", TIMES, lambda time: inverse(first) @ robot(time) @ LIDAR)
    write_poses("truth/rear.tum", REAR_TIMES, lambda time: robot(time) @ REAR)
    write_poses("truth/depth.tum", TIMES, lambda time: robot(time) @ CAMERA @ OPTICAL)
    write_poses("truth/laser_in_odom.tum", TIMES, lambda time: robot_in_odom(time) @ LASER)
    with open("truth/lidar_on_robot.txt", "w") as out:
        out.write(" ".join(repr(float(v)) for v in list(LIDAR[:3, 3]) + quaternion(LIDAR[:3, :3])) + "\n")


write_mcaps(sys.argv[1])
write_folders()
write_ros1()
write_truth()
