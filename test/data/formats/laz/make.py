#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the points of the LAZ files of this directory, as uncompressed LAS files and as .records files.

usage: make.py DIRECTORY [POINTS]

The points are a scan with pulses of several returns, and a part in which every attribute is random. A .records file
holds the records of a LAS file without its header.

The LAZ files were compressed from the LAS files by writers that are independent of our decoder: LASzip 3.5
("laszip_NAME") and laz-perf 3.4 ("lazperf_NAME"), 64 points per chunk. The endings say what is special:
  variable  each chunk has its own number of points
  pipe      written to a pipe, so that the position of the table of chunks is at the end of the file
  v1        compression of the first LASzip: one chunk without a table; with extra bytes: 64 points per chunk
  v4        compression of LAS 1.5, which differs from version 3 if there are several scanner channels
Independent readers gave the same records: the npm package laz-perf 0.0.7 (read.mjs) for all files but those with pipe,
v1 or v4, which it cannot read, and LASzip 3.5 for all.
"""
import math
import os
import random
import struct
import sys

# name: (point format, extra bytes, scanner channels)
FILES = {
    "format0": (0, 0, 1), "format1": (1, 0, 1), "format2": (2, 0, 1), "format3": (3, 0, 1),
    "format3_extra": (3, 5, 1), "format6": (6, 0, 1), "format7": (7, 0, 1), "format8": (8, 0, 1),
    "format7_channels": (7, 2, 4), "format8_channels": (8, 3, 3),
}
LENGTHS = {0: 20, 1: 28, 2: 26, 3: 34, 6: 30, 7: 36, 8: 38}


def records(point_format, extra, channels, count):
    rng = random.Random(point_format * 100 + extra * 10 + channels)
    x, y, time = 1000, -2000, 3.2e5
    source, angle, cls, number, returns, channel = 17, 3, 2, 1, 1, 0
    red, nir, user = 20000, 30000, 0
    extras = [0] * extra
    for i in range(count):
        wild = i % 100 >= 80
        if number >= returns:
            number, returns = 1, rng.choice([1, 1, 1, 1, 2, 2, 3, 4, 7 if point_format < 6 else 12])
            time += 1e-5 * rng.choice([1, 1, 1, 1, 1, 2, 3, 20, 400, 700, -5, 0])
            if rng.random() < 0.03:
                time = rng.choice([3.2e5, 4.1e5, 5.3e5, 1e9]) + i * 1e-4
            x += 40 + rng.randrange(7)
            y += round(60 * math.sin(i / 9)) + rng.randrange(5)
            channel = (channel if rng.random() < 0.8 else rng.randrange(channels))
        else:
            number += 1
            x += rng.randrange(3)
        z = round(500 * math.sin(i / 30)) + 300 * (returns - number) + rng.randrange(9)
        intensity = 200 + 50 * number + rng.randrange(30)
        if rng.random() < 0.1:
            cls = rng.choice([1, 2, 5, 6])
        if rng.random() < 0.05:
            angle, source, user = rng.randrange(-20, 20), rng.randrange(15, 20), rng.randrange(4)
        red = (red + rng.randrange(-300, 300)) & 0xFFFF
        green, blue = (red + rng.randrange(200)) & 0xFFFF, (red + 256 * rng.randrange(3)) & 0xFFFF
        if rng.random() < 0.3:
            green = blue = red
        nir = (nir + rng.choice([0, 0, 1, 256, 700])) & 0xFFFF
        extras = [(e + rng.choice([0, 0, 0, 1, 255])) & 255 if k != 1 else 7 for k, e in enumerate(extras)]
        bits = lambda n: rng.getrandbits(n)
        point = [x, y, z, intensity, number, returns, cls, angle, user, source, time, red, green, blue, nir]
        flags, legacy = i // 50 % 2, number | returns << 3 | (i // 20 % 2) << 6
        if wild:
            point = [bits(32) - 2**31, bits(32) - 2**31, bits(32) - 2**31, bits(16), bits(4), bits(4), bits(8),
                     bits(16) - 2**15, bits(8), bits(16), 0, bits(16), bits(16), bits(16), bits(16)]
            point[10] = struct.unpack("<d", struct.pack("<Q", bits(64)))[0]
            flags, legacy, channel = bits(8), bits(8), rng.randrange(channels)
            extras = [bits(8) if k != 1 else 7 for k in range(extra)]
        time_bytes = struct.pack("<d", point[10])
        if point_format < 6:
            record = struct.pack("<iiiHBBbBH", *point[:4], legacy, point[6], (point[7] + 128) % 256 - 128, *point[8:10])
            record += time_bytes if point_format in (1, 3) else b""
            record += struct.pack("<HHH", *point[11:14]) if point_format >= 2 else b""
        else:
            flags = flags & 0xCF | channel << 4
            record = struct.pack("<iiiHBBBBhH", *point[:4], point[4] | point[5] << 4, flags, point[6], point[8],
                                 point[7], point[9]) + time_bytes
            record += struct.pack("<HHH", *point[11:14]) if point_format >= 7 else b""
            record += struct.pack("<H", point[14]) if point_format == 8 else b""
        yield record + bytes(extras)


def las(point_format, extra, channels, count):
    minor, size = (2, 227) if point_format < 6 else (4, 375)
    length = LENGTHS[point_format] + extra
    header = bytearray(size)
    header[:4] = b"LASF"
    header[24:26] = bytes([1, minor])
    header[26:30], header[58:65] = b"test", b"make.py"
    struct.pack_into("<HHHIIBHI", header, 90, 1, 2026, size, size, 0, point_format, length, count)
    struct.pack_into("<6d", header, 131, 0.01, 0.01, 0.001, 5000.0, 6000.0, 70.0)
    if minor == 4:
        header[6] = 16
        struct.pack_into("<Q", header, 247, count)
    return bytes(header) + b"".join(records(point_format, extra, channels, count))


def main():
    directory, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 150
    for name, (point_format, extra, channels) in FILES.items():
        with open(os.path.join(directory, name + ".las"), "wb") as file:
            file.write(las(point_format, extra, channels, count))
        with open(os.path.join(directory, name + ".records"), "wb") as file:
            file.write(b"".join(records(point_format, extra, channels, count)))


main()
