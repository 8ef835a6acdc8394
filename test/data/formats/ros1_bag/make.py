#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the bags of this folder, and what rosbag reads in them (.txt: topic, time [ns], size, CRC-32 of every message).

Debian 12: python3-rosbag 1.15.15, python3-std-msgs 0.5.13, python3-roslz4 1.15.15.
"""
import os
import shutil
import zlib

import rosbag
from genpy import Time
from std_msgs.msg import Empty, String, UInt8MultiArray


def fill(bag):
    for i in range(40):
        time = Time(1700000000 + (i - 3 if i % 5 == 3 else i), 250000000)
        if i == 7:
            bag.write("/empty", Empty(), time)
        elif i % 4 == 0:
            bag.write("/cloud", UInt8MultiArray(data=bytes((i + (k >> 3)) & 255 for k in range(300 + i))), time)
        else:
            bag.write("/text", String(data="message %d" % i), time)
        if i == 20:  # a second sender of the topic
            header = {"callerid": "/other", "topic": "/text", "type": "std_msgs/String",
                      "md5sum": String._md5sum, "message_definition": String._full_text}
            bag.write("/text", String(data="second sender"), time, connection_header=header)


def listed(name, listing, unfinished=False):
    bag = rosbag.Bag(name, "a" if unfinished else "r", allow_unindexed=True)
    if unfinished:  # reindexing changes the file
        for _ in bag.reindex():
            pass
        bag.close()
        bag = rosbag.Bag(name)
    with open(listing, "w") as out:
        for topic, raw, time in bag.read_messages(raw=True):
            out.write("%s %d %d %08x\n" % (topic, time.to_nsec(), len(raw[1]), zlib.crc32(raw[1])))


for compression in ("none", "bz2", "lz4"):
    with rosbag.Bag(compression + ".bag", "w", compression=compression, chunk_threshold=1500) as bag:
        fill(bag)
        if compression == "bz2":  # the last chunk is open
            bag._file.flush()
            shutil.copy("bz2.bag", "unfinished.bag")
    listed(compression + ".bag", compression + ".txt")
for compression in ("bz2", "lz4"):  # the same messages
    assert open(compression + ".txt").read() == open("none.txt").read()
    os.remove(compression + ".txt")
os.rename("none.txt", "messages.txt")
shutil.copy("unfinished.bag", "copy.bag")
listed("copy.bag", "unfinished.txt", unfinished=True)
os.remove("copy.bag")
