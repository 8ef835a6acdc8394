#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the databases of this folder as rosbag2 does, with Python's sqlite3 (3.40.1 in Debian 12) and the program zstd
(1.5.4), and lists the messages (.txt: topic, time [ns], size, CRC-32, in the order of the times).

The statements that make the tables are those in the files that rosbag2 writes: version 1 (Foxy), and 4 (Iron, Jazzy).
"""
import os
import sqlite3
import subprocess
import zlib

TOPICS = [(1, "/points", "sensor_msgs/msg/PointCloud2", "cdr"), (2, "/tf", "tf2_msgs/msg/TFMessage", "cdr"),
          (5, "/other", "some_msgs/msg/Other", "json")]
VERSION_1 = """
CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""
VERSION_4 = """
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


def message(i):
    topic = TOPICS[i % 3][0]
    time = 1700000000000000000 + (i - 3 if i % 5 == 3 else i) * 50000000
    size = 6000 if i == 12 else 0 if i == 8 else 40 + i
    return topic, time, (b"\0\1\0\0" + bytes((i + (k >> 3)) & 255 for k in range(size)))[:size]


def zstd_file(name, packed):
    subprocess.run(["zstd", "-q", "-f", "-19", name, "-o", packed], check=True)


def write(name, tables, numbers, pack=lambda topic, data: data):
    if os.path.exists(name):
        os.remove(name)
    database = sqlite3.connect(name)
    database.executescript("PRAGMA page_size = 1024;" + tables)
    for row in TOPICS:
        more = ("", "") if tables is VERSION_4 else ()
        database.execute("INSERT INTO topics VALUES(%s)" % ",".join("?" * (4 + len(more))), row + more)
    for i in numbers:
        topic, time, data = message(i)
        database.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)", (topic, time, pack(topic, data)))
    database.commit()
    database.close()


def listed(name, listing):
    database = sqlite3.connect(name)
    with open(listing, "w") as out:
        for row in database.execute("SELECT name, timestamp, data FROM messages JOIN topics ON topics.id = topic_id "
                                    "ORDER BY timestamp, messages.id"):
            out.write("%s %d %d %08x\n" % (row[0], row[1], len(row[2]), zlib.crc32(row[2])))


def metadata(files):
    lines = ["rosbag2_bagfile_information:", "  version: 5", "  storage_identifier: sqlite3", "  relative_file_paths:"]
    return "\n".join(lines + ["    - " + name for name in files]) + "\n"


def zstd_with_size(data):  # a pipe has no size, but rosbag2 stores it
    with open("part", "wb") as out:
        out.write(data)
    zstd_file("part", "part.zst")
    with open("part.zst", "rb") as packed:
        data = packed.read()
    os.remove("part")
    os.remove("part.zst")
    return data


write("version1.db3", VERSION_1, range(30))
listed("version1.db3", "messages.txt")
write("version4.db3", VERSION_4, range(30))
write("packed_messages.db3", VERSION_1, range(30), lambda topic, data: zstd_with_size(data) if topic != 5 else data)
os.makedirs("split", exist_ok=True)
for part in range(2):
    name = "split_%d.db3" % part
    write(name, VERSION_4, range(15 * part, 15 * part + 15))
    zstd_file(name, "split/" + name + ".zstd")
    os.remove(name)
with open("split/metadata.yaml", "w") as out:
    out.write(metadata(["split_0.db3.zstd", "split_1.db3.zstd"]))
