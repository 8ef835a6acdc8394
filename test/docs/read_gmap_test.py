#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The reader of docs/file-format.md beside `gaussmap export`: every value of every Gaussian of every scale.
Usage: read_gmap_test.py GAUSSMAP [MAP...]: the maps are compared, too. Exit code 77 if numpy or zstandard is missing."""
import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import zstandard  # noqa: F401: the reader needs it
except ImportError as error:
    print(f"skipped: {error}; install python3-numpy and python3-zstandard (cmake/install-deps.sh --checks)")
    sys.exit(77)

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs/examples"))
from read_gmap import read_gmap  # noqa: E402

READER = pathlib.Path(sys.path[0]) / "read_gmap.py"
MAPS = {  # name: command that makes it, how far values may differ (relative)
    "with moments": ("pcd2map world/scans -o moments.gmap", 0.0),
    "refined": ("refine moments.gmap -o refined.gmap --budget 3", 0.0),
    "of another ratio": ("pcd2map world/scans -o ratio.gmap --ratio 2 --scales 4", 0.0),
    "compressed": ("compress refined.gmap -o compressed.gmap --max-error 0.1", 0.0),
    "moved": ("transform refined.gmap -o moved.gmap --transform '-1000 200 3 0 0 0.6 0.8'", 0.0),
    "on line": ("pcd2map world/scans -o online.gmap --online", 0.0),
    "final": ("finish refined.gmap -o final.gmap", 1e-9),
    "final, compressed": ("finish compressed.gmap -o small.gmap", 1e-9),
    "final, with log-odds": ("finish online.gmap -o odds.gmap", 1e-9),
}


def in_key_order(keys, values):
    """Rows sorted by cell; the Gaussians of a cell keep their order."""
    return np.hstack([keys, values])[np.lexsort(keys.T[::-1])]


def exported(path):
    """scale -> rows: cell, mean, covariance, weight, log-odds."""
    scales = {}
    with open(path, newline="") as file:
        for row in list(csv.reader(file))[1:]:
            scales.setdefault(int(row[0]), []).append([float(value) for value in row[2:]])
    return {scale: np.array(rows) for scale, rows in scales.items()}


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    lines = len(READER.read_text().splitlines())
    if lines > 60:
        sys.exit(f"{READER.name} has {lines} lines, at most 60 are promised")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def gaussmap(arguments):
            subprocess.run(f"'{program}' {arguments}", shell=True, cwd=folder, check=True, stdout=subprocess.DEVNULL)

        gaussmap("simulate corner -o world")
        cases = [(title, command, command.split(" -o ")[1].split()[0], tolerance)
                 for title, (command, tolerance) in MAPS.items()]
        for path in sys.argv[2:]:
            shutil.copy(path, folder)
            cases.append((pathlib.Path(path).name, None, pathlib.Path(path).name, 0.0))
        for title, command, file, tolerance in cases:
            if command:
                gaussmap(command)
            gaussmap(f"export {file} {file}.csv")
            count = 0
            for scale, rows in exported(folder / f"{file}.csv").items():
                tiles = list(read_gmap(folder / file, scale))
                values = [np.hstack([means, covs, weights[:, None], odds[:, None]])
                          for _, means, covs, weights, odds in tiles]
                got = in_key_order(np.vstack([keys for keys, *_ in tiles]), np.vstack(values))
                rows[:, -1] = rows[:, -1].astype(np.float32)  # the file has floats, the text has their shortest decimals
                want = in_key_order(rows[:, :3], rows[:, 3:])
                if got.shape != want.shape:
                    sys.exit(f"{title}, scale {scale}: {got.shape} instead of {want.shape} numbers")
                worst = np.max(np.abs(got - want) / np.maximum(np.abs(want), 1e-3))
                if not worst <= tolerance:
                    sys.exit(f"{title}, scale {scale}: values differ by {worst:g} of their size")
                count += len(got)
            printed = subprocess.run([sys.executable, str(READER), str(folder / file), "1"], check=True,
                                     capture_output=True, text=True).stdout.splitlines()
            if len(printed) != len(exported(folder / f"{file}.csv").get(1, [])):
                sys.exit(f"{title}: the program prints {len(printed)} lines")
            print(f"{title}: {count} Gaussians " + (f"within {tolerance:g}" if tolerance else "bit-identical"))


if __name__ == "__main__":
    main()
