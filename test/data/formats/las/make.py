# SPDX-License-Identifier: BSD-3-Clause
"""Writes the LAS files of this folder and the values that a reader must return.

The writer uses only the LAS specification (ASPRS, 1.0 to 1.4-R15) and the module struct, and shares no code with
gaussmap. Two independent readers give the same values as the .txt files: laspy 2.7.0 (which does not turn no-data into NaN)
and @loaders.gl/las 4.5.1 (coordinates of the versions up to 1.2, which are all that it reads).
Run: python3 make.py. A .txt file has the names of the columns, then one line per point.
"""
import random
import struct

NAN = float("nan")


def number(value):
    return "nan" if value != value else repr(float(value))


class File:
    def __init__(self, name, minor, fmt, count=7, seed=1, scale=(0.001, 0.001, 0.01), offset=(448000.0, 5411000.0, 0.5)):
        self.name, self.minor, self.fmt, self.scale, self.offset = name, minor, fmt, scale, offset
        self.random = random.Random(seed + 100 * fmt + minor)
        self.columns, self.records, self.vlrs, self.evlrs, self.extra = {}, [], [], [], []
        self.encoding, self.legacy, self.padding, self.colours16 = 0, True, 0, True
        self.points = [self.point() for _ in range(count)]

    def point(self):
        r = self.random
        p = {"X": r.randrange(-(2**31), 2**31), "Y": r.randrange(-(10**6), 10**6), "Z": r.randrange(-3000, 9000)}
        new = self.fmt >= 6
        p["intensity"] = r.randrange(65536)
        p["return_number"] = r.randrange(1, 16 if new else 8)
        p["number_of_returns"] = r.randrange(1, 16 if new else 8)
        p["classification"] = r.randrange(256 if new else 32)
        p["flags"] = r.randrange(16 if new else 8)  # synthetic, key point, withheld, overlap
        p["channel"], p["direction"], p["edge"] = r.randrange(4), r.randrange(2), r.randrange(2)
        p["angle"] = r.randrange(-30000, 30001) if new else r.randrange(-90, 91)
        p["user_data"], p["source"] = r.randrange(256), r.randrange(65536)
        p["time"] = r.uniform(0.0, 4e8)
        p["rgb"] = [r.randrange(65536) for _ in range(3)]
        p["nir"] = r.randrange(65536)
        p["wave"] = [r.randrange(256), r.randrange(2**40), r.randrange(2**32)] + [r.uniform(-1, 1) for _ in range(4)]
        return p

    def record(self, p):
        f = self.fmt
        b = struct.pack("<3iH", p["X"], p["Y"], p["Z"], p["intensity"])
        if f < 6:
            b += struct.pack("<BBbBH", p["return_number"] | p["number_of_returns"] << 3 | p["direction"] << 6 | p["edge"] << 7,
                             p["classification"] | p["flags"] << 5, p["angle"], p["user_data"], p["source"])
            if f in (1, 3, 4, 5):
                b += struct.pack("<d", p["time"])
        else:
            b += struct.pack("<BBBBhHd", p["return_number"] | p["number_of_returns"] << 4,
                             p["flags"] | p["channel"] << 4 | p["direction"] << 6 | p["edge"] << 7, p["classification"],
                             p["user_data"], p["angle"], p["source"], p["time"])
        if f in (2, 3, 5, 7, 8, 10):
            b += struct.pack("<3H", *p["rgb"])
        if f in (8, 10):
            b += struct.pack("<H", p["nir"])
        if f in (4, 5, 9, 10):
            b += struct.pack("<BQI4f", *p["wave"])
        return b + b"".join(struct.pack("<" + code, *values) for code, values in p.get("extra", []))

    def values(self, p):
        f = self.fmt
        v = {axis: p[axis.upper()] * self.scale[i] + self.offset[i] for i, axis in enumerate("xyz")}
        for name in ("intensity", "return_number", "number_of_returns", "classification", "user_data"):
            v[name] = p[name]
        v["withheld"] = p["flags"] >> 2 & 1
        v["scan_angle"] = p["angle"] if f < 6 else p["angle"] * 0.006
        v["point_source_id"] = p["source"]
        if f >= 6:
            v["overlap"], v["scanner_channel"] = p["flags"] >> 3, p["channel"]
        if f not in (0, 2):
            v["time"] = p["time"]
        if f in (2, 3, 5, 7, 8, 10):
            shift = 8 if self.colours16 else 0
            v["rgb"] = p["rgb"][0] >> shift << 16 | p["rgb"][1] >> shift << 8 | p["rgb"][2] >> shift
        if f in (8, 10):
            v["nir"] = p["nir"]
        v.update(p.get("extra_values", {}))
        return v

    def vlr(self, user, number_, data, description="", extended=False):
        head = struct.pack("<H16sH", 0, user.encode(), number_)
        head += struct.pack("<Q" if extended else "<H", len(data)) + struct.pack("<32s", description.encode())
        (self.evlrs if extended else self.vlrs).append(head + data)

    def write(self):
        header_size = 227 if self.minor <= 2 else 235 if self.minor == 3 else 375
        vlrs, points = b"".join(self.vlrs), b"".join(self.record(p) for p in self.points)
        if self.minor == 0:
            vlrs += b"\xdd\xcc"  # version 1.0 has this mark in front of the points
        vlrs += bytes(self.padding)
        start = header_size + len(vlrs)
        n = len(self.points)
        legacy = n if self.fmt < 6 and self.legacy else 0
        returns = [sum(p["return_number"] == i + 1 for p in self.points) for i in range(15)]
        coordinates = [[p[a] * self.scale[i] + self.offset[i] for p in self.points] for i, a in enumerate("XYZ")]
        h = b"LASF" + struct.pack("<HH16x", 0, self.encoding) + bytes([1, self.minor])
        h += struct.pack("<32s32sHHHIIBHI", b"gaussmap", b"make.py", 1, 2024, header_size, start, len(self.vlrs), self.fmt,
                         len(points) // n, legacy)
        h += struct.pack("<5I", *(returns[:5] if legacy else [0] * 5))
        h += struct.pack("<6d", *self.scale, *self.offset)
        for c in coordinates:
            h += struct.pack("<2d", max(c), min(c))
        end = start + len(points)
        if self.minor >= 3:
            h += struct.pack("<Q", 0)
        if self.minor >= 4:
            h += struct.pack("<QIQ15Q", end if self.evlrs else 0, len(self.evlrs), n, *returns)
        assert len(h) == header_size
        with open(self.name + ".las", "wb") as file:
            file.write(h + vlrs + points + b"".join(self.evlrs))
        rows = [self.values(p) for p in self.points]
        with open(self.name + ".txt", "w") as file:
            print(*rows[0].keys(), file=file)
            for row in rows:
                print(*(number(value) for value in row.values()), file=file)


def geo_keys(pairs, names):
    data = struct.pack("<4H", 1, 1, 0, len(pairs)) + b"".join(struct.pack("<4H", *pair) for pair in pairs)
    return data, names.encode() + b"\0"


WKT = ('PROJCS["WGS 84 / UTM zone 32N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
       'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
       'PARAMETER["central_meridian",9],UNIT["metre",1],AUTHORITY["EPSG","32632"]]')


def extra(data_type, options, name, no_data=b"", scale=(), offset=()):
    pad = lambda data, size: data + bytes(size - len(data))
    return (struct.pack("<2xBB32s4x", data_type, options, name.encode()) + pad(no_data, 24) + bytes(48) +
            pad(struct.pack("<%dd" % len(scale), *scale), 24) + pad(struct.pack("<%dd" % len(offset), *offset), 24) +
            bytes(32))


def main():
    for fmt, minor in ((0, 0), (1, 0), (0, 1), (1, 1), (2, 2), (3, 2), (4, 3), (5, 3), (0, 4), (6, 4), (7, 4), (8, 4), (9, 4),
                       (10, 4)):
        f = File("format%d_1.%d" % (fmt, minor), minor, fmt)
        if minor < 4:
            data, names = geo_keys([(1024, 0, 1, 1), (3072, 0, 1, 32632), (3073, 34737, 22, 0), (3076, 0, 1, 9001)],
                                   "WGS 84 / UTM zone 32N|")
            f.vlr("LASF_Projection", 34735, data)
            f.vlr("LASF_Projection", 34737, names)
        else:
            f.encoding = 0x11
            f.vlr("LASF_Projection", 2112, WKT.encode() + b"\0", "WKT", extended=fmt % 2 == 0)
        f.padding = fmt
        f.write()

    f = File("colours8", 2, 2)
    f.colours16 = False
    for p in f.points:
        p["rgb"] = [c & 255 for c in p["rgb"]]
    f.write()

    # Extra bytes of all types, with scale, offset, no-data, an array, and bytes without meaning in between.
    f = File("extra_bytes", 4, 1, count=5)
    f.legacy = False
    codes = "BbHhIiQqfd"
    f.vlr("LASF_Spec", 4, b"".join(
        [extra(i + 1, 0, "type_%d" % (i + 1)) for i in range(10)] +
        [extra(0, 3, "nothing"),
         extra(3, 8 | 16, "height", scale=(0.25,), offset=(-8.0,)),
         extra(4, 1, "gap", no_data=struct.pack("<q", -5)),
         extra(5, 1, "wide_gap", no_data=struct.pack("<Q", 2**32 - 1)),
         extra(9, 1, "real_gap", no_data=struct.pack("<d", -1.5)),
         extra(24, 8, "normal", scale=(0.5, 0.25, 0.125)),
         extra(11, 0, "pair")]), "extra bytes")
    limits = {"B": (0, 255), "b": (-128, 127), "H": (0, 65535), "h": (-32768, 32767), "I": (0, 2**32 - 1),
              "i": (-(2**31), 2**31 - 1), "Q": (0, 2**53), "q": (-(2**53), 2**53)}
    for i, p in enumerate(f.points):
        r = f.random
        items, values = [], {}
        for k, code in enumerate(codes):
            value = r.randrange(-1000, 1000) / 8 if code in "fd" else r.choice([*limits[code], r.randint(*limits[code])])
            items.append((code, [value]))
            values["type_%d" % (k + 1)] = value
        items.append(("3B", [r.randrange(256) for _ in range(3)]))
        height, gap, wide, real = r.randrange(65536), [-5, 7][i % 2], [9, 2**32 - 1][i % 2], [-1.5, 2.5][i % 2]
        normal, pair = [r.randrange(-100, 100) for _ in range(3)], [r.randrange(256) for _ in range(2)]
        items += [("H", [height]), ("h", [gap]), ("I", [wide]), ("f", [real]), ("3h", normal), ("2B", pair)]
        values.update({"height": height * 0.25 - 8.0, "gap": NAN if gap == -5 else gap,
                       "wide_gap": NAN if wide == 2**32 - 1 else wide, "real_gap": NAN if real == -1.5 else real})
        values.update({"normal[%d]" % j: normal[j] * (0.5, 0.25, 0.125)[j] for j in range(3)})
        values.update({"pair[%d]" % j: pair[j] for j in range(2)})
        p["extra"], p["extra_values"] = items, values
    f.write()


main()
