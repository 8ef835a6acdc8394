#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the text clouds and raw records of the tests, and the values that an independent reader finds in them.

Writer and reader of the tables and of the raw records: numpy 1.24.2 (Debian python3-numpy 1:1.24.2-1+deb12u1),
np.savetxt, np.loadtxt, tofile and fromfile. For PTX, numpy writes the blocks, and read_ptx() below is a second reader,
written from the description of the format by Leica. two.ptx.cloudcompare is what CloudCompare
2.11.3-7.1 (Debian) reads: the points with a return, in the map frame, as floats:
  CloudCompare -SILENT -AUTO_SAVE OFF -O two.ptx -C_EXPORT_FMT ASC -PREC 12 -SAVE_CLOUDS, then cat two_*.asc

Usage: make.py (in this folder)
"""
import io

import numpy as np

rng = np.random.default_rng(20)
N = 40


def expect(name, rows):
    """Writes <name>.expected: one row per point, 17 digits, read back by numpy as the same doubles."""
    np.savetxt(name + ".expected", rows, fmt="%.17g")


def cloud(n=N, scale=30.0):
    return rng.normal(size=(n, 3)) * scale


def packed(rgb):
    r, g, b = np.asarray(rgb, dtype=np.int64).T
    return (r << 16 | g << 8 | b).astype(float)


def write(name, text):
    with open(name, "w", newline="") as file:
        file.write(text)


def table(columns, fmt, delimiter=" ", header="", comments="", newline="\n"):
    out = io.StringIO()
    np.savetxt(out, columns, fmt=fmt, delimiter=delimiter, header=header, comments=comments, newline=newline)
    return out.getvalue()


def read(name, skip=0, delimiter=None, comments="#", usecols=None):
    return np.loadtxt(name, skiprows=skip, delimiter=delimiter, comments=comments, usecols=usecols, ndmin=2)


# x y z and intensity, no header, all digits of a double, exponents
write("plain.xyz", table(np.c_[cloud(), rng.random(N)], "%.17g"))
expect("plain.xyz", read("plain.xyz"))
write("exponents.txt", table(cloud(scale=1e-4), "%.16e", newline="\r\n", header="x y z", comments="# "))
expect("exponents.txt", read("exponents.txt"))

# far from the origin, semicolons, header with units
write("utm.csv", table(cloud() + [452345.123, 5412345.678, 312.5], "%.4f", ";", "x [m];y [m];z [m]"))
expect("utm.csv", read("utm.csv", 1, ";"))

# as ParaView writes it: values first, quotes, coordinates as Points:0
text = table(np.c_[rng.integers(0, 128, N), rng.random(N), cloud()], "%.9g", ",",
             '"ring","intensity","Points:0","Points:1","Points:2"')
write("paraview.csv", text)
expect("paraview.csv", read("paraview.csv", 1, ",", usecols=(2, 3, 4, 0, 1)))

# as CloudCompare writes it: header behind //, colours, normals, the number of points in a line of its own
normals = cloud()
normals /= np.linalg.norm(normals, axis=1)[:, None]
rgb = rng.integers(0, 256, (N, 3))
write("cloudcompare.asc", "//X Y Z R G B Nx Ny Nz\n%d\n" % N +
      table(np.c_[cloud(), rgb, normals], ["%.8f"] * 3 + ["%d"] * 3 + ["%.6f"] * 3))
rows = read("cloudcompare.asc", 2)
expect("cloudcompare.asc", np.c_[rows[:, :3], packed(rows[:, 3:6]), rows[:, 6:]])

# PTS with two blocks
blocks = []
text = ""
for n in (N, 7):
    part = table(np.c_[cloud(n), rng.integers(-2048, 2048, n), rng.integers(0, 256, (n, 3))], ["%.6f"] * 3 + ["%d"] * 4)
    text += "%d\r\n" % n + part.replace("\n", "\r\n")
    rows = np.loadtxt(io.StringIO(part))
    blocks.append(np.c_[rows[:, :4], packed(rows[:, 4:])])
write("two.pts", text)
expect("two.pts", np.vstack(blocks))

# no header: normals; tabs and times in nanoseconds; NaN and infinity
write("normals.txt", table(np.c_[cloud(), normals], "%.7f", "\t"))
expect("normals.txt", read("normals.txt"))
times = 1700000000000000000 + rng.integers(0, 10**8, N)
points = cloud()
write("times.csv", "timestamp_ns,X,Y,Z,Reflectance\n" +
      "".join("%d,%.3f,%.3f,%.3f,%d\n" % (t, *p, i) for t, p, i in zip(times, points, rng.integers(0, 256, N))))
rows = read("times.csv", 1, ",")
expect("times.csv", np.c_[rows[:, 1:4], rows[:, 0] / 1e9, rows[:, 4]])
points[3] = np.nan
points[5, 0] = np.inf
points[6, 2] = -np.inf
write("nan.xyz", table(points, "%.5f"))
expect("nan.xyz", read("nan.xyz"))

# PTX with two scans: the points of a column of the scanner follow each other
def rotation(x, y, z):
    a, b, c = np.cos([x, y, z]), np.sin([x, y, z]), None
    rx = np.array([[1, 0, 0], [0, a[0], -b[0]], [0, b[0], a[0]]])
    ry = np.array([[a[1], 0, b[1]], [0, 1, 0], [-b[1], 0, a[1]]])
    rz = np.array([[a[2], -b[2], 0], [b[2], a[2], 0], [0, 0, 1]])
    return rz @ ry @ rx


text = ""
for (columns, rows_per_column), angles, position, colours in (
        ((5, 4), (0.1, -0.2, 2.5), (10.5, -20.25, 1.75), True), ((3, 6), (0.0, 0.3, -1.0), (451.5, 0.0, 7.0), False)):
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(*angles).T  # rows: images of the axes
    matrix[3, :3] = position
    n = columns * rows_per_column
    points = np.c_[cloud(n, 8.0), rng.random(n)]
    points[[2, 9]] = [0, 0, 0, 0.5]  # no return
    text += "%d\n%d\n" % (columns, rows_per_column) + table(matrix[[3, 0, 1, 2], :3], "%.9f") + table(matrix, "%.9f")
    fmt = ["%.6f"] * 4
    if colours:
        points = np.c_[points, rng.integers(0, 256, (n, 3))]
        fmt += ["%d"] * 3
    text += table(points, fmt)
write("two.ptx", text)


def read_ptx(name):
    """Yields the rows of each scan: x y z in the map frame, x y z in the scanner frame, the other numbers."""
    lines = open(name).read().split("\n")
    at = 0
    while at < len(lines) and lines[at].strip():
        count = int(lines[at]) * int(lines[at + 1])
        matrix = np.array([[float(w) for w in line.split()] for line in lines[at + 6:at + 10]])
        body = np.array([[float(w) for w in line.split()] for line in lines[at + 10:at + 10 + count]])
        moved = np.c_[body[:, :3], np.ones(count)] @ matrix  # p * M
        body[(body[:, :3] == 0).all(axis=1), :3] = np.nan
        moved[np.isnan(body[:, 0]), :3] = np.nan
        yield np.c_[moved[:, :3], body[:, :4], packed(body[:, 4:7]) if body.shape[1] == 7 else np.full(count, np.nan)]
        at += 10 + count


expect("two.ptx", np.vstack(list(read_ptx("two.ptx"))))

# raw records
records = np.c_[cloud(), rng.random(N)].astype("<f4")
records.tofile("kitti.bin")
expect("kitti.bin", np.fromfile("kitti.bin", "<f4").reshape(-1, 4).astype(float))
records = np.c_[cloud(), rng.integers(0, 256, N), np.arange(N) % 32].astype("<f4")
records.tofile("nuscenes.pcd.bin")
expect("nuscenes.pcd.bin", np.fromfile("nuscenes.pcd.bin", "<f4").reshape(-1, 5).astype(float))
kind = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f8"), ("ring", "<u2"), ("skip", "u1"), ("time", "<u4"),
                 ("label", "<i4"), ("a", "i1"), ("b", "<i2")])
mixed = np.zeros(N, kind)
for name, values in (("x", cloud()[:, 0]), ("y", cloud()[:, 0]), ("z", cloud()[:, 0]), ("ring", rng.integers(0, 65536, N)),
                     ("skip", 7), ("time", rng.integers(0, 2**32, N)), ("label", rng.integers(-2**31, 2**31, N)),
                     ("a", rng.integers(-128, 128, N)), ("b", rng.integers(-32768, 32768, N))):
    mixed[name] = values
mixed.tofile("mixed.bin")
back = np.fromfile("mixed.bin", kind)
expect("mixed.bin", np.c_[back["x"], back["y"], back["z"], back["ring"], back["time"] / 1e9, back["label"], back["a"],
                          back["b"]])
