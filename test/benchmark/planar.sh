#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures planar maps, for docs/planar.md: the error at the walls of a slice and of the 3-D map, the on-line rate on the
# log of the Intel lab, and the registration of scans that the map does not hold.
# DATA has the folders sim_hall_20scans (30 m x 20 m, walls at x = 0, x = 30, y = 0, y = 20) and carmen_intel (the log,
# its scans as 0000.pcd ..., and trajectory.tum).
# Usage: test/benchmark/planar.sh GAUSSMAP DATA
set -euo pipefail
gaussmap=$(realpath "${1:?usage: planar.sh GAUSSMAP DATA}")
data=$(realpath "${2:?usage: planar.sh GAUSSMAP DATA}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# The scans of the hall with a noise of 2 cm along the rays. clean writes them as floats.
"$gaussmap" clean "$data/sim_hall_20scans" -o exact >log
python3 - <<'PYTHON'
import array, glob, math, os, random
random.seed(1)
os.makedirs("noisy")
for path in sorted(glob.glob("exact/*.pcd")):
    content = open(path, "rb").read()
    begin = content.index(b"DATA binary\n") + len(b"DATA binary\n")
    points = array.array("f", content[begin:])
    for i in range(0, len(points), 3):
        distance = math.sqrt(points[i] ** 2 + points[i + 1] ** 2 + points[i + 2] ** 2)
        factor = 1.0 + random.gauss(0.0, 0.02) / distance
        for axis in range(3):
            points[i + axis] *= factor
    open("noisy/" + os.path.basename(path), "wb").write(content[:begin] + points.tobytes())
PYTHON
for scans in exact noisy; do
  "$gaussmap" pcd2map --planar --slice 0.5 1.5 $scans -o slice.gmap --noise 0.0005 --force >log
  "$gaussmap" pcd2map $scans -o space.gmap --crop -5 -5 0.5 35 25 1.5 --noise 0.0005 --force >log
  for map in slice space; do "$gaussmap" export $map.gmap $scans-$map.csv >log; done
done
python3 - <<'PYTHON'
import csv, math
def error(path, scale):
    """RMS distance of the mass of the Gaussians from the nearest wall [m], and their number."""
    total = weight = count = 0.0
    for row in csv.DictReader(open(path)):
        if int(row["scale"]) != scale:
            continue
        x, y = float(row["x"]), float(row["y"])
        distance, axis = min((abs(x), "xx"), (abs(x - 30), "xx"), (abs(y), "yy"), (abs(y - 20), "yy"))
        total += float(row["weight"]) * (distance ** 2 + float(row["cov_" + axis]))
        weight += float(row["weight"])
        count += 1
    return math.sqrt(total / weight), int(count)
print("error at the walls: ranges, scale, planar map of a slice [mm] (Gaussians), 3-D map, ratio")
for scans in ("exact", "noisy"):
    for scale in range(3):
        (planar, n), (space, m) = error(scans + "-slice.csv", scale), error(scans + "-space.csv", scale)
        print(f"{scans} {scale}  {1e3 * planar:.3f} ({n})  {1e3 * space:.3f} ({m})  {planar / space:.3f}")
PYTHON

log=$data/carmen_intel/intel-corrected.log.gz
TIMEFORMAT="on line: %U s of processor time for the whole log"
time "$gaussmap" pcd2map --planar --online "$log" -o online.gmap --resolution 0.05 --threads 1 2>/dev/null

# The even scans make the map. The guesses of the odd ones are 20 cm and 3 degrees beside their poses.
mkdir odd
python3 - "$data/carmen_intel" <<'PYTHON'
import math, os, random, sys
random.seed(1)
rows = [line for line in open(sys.argv[1] + "/trajectory.tum") if not line.startswith("#")]
guesses, truth = open("guesses.tum", "w"), open("truth.tum", "w")
for i in range(1, len(rows), 2):
    _, x, y, _, _, _, qz, qw = map(float, rows[i].split())
    way, half = random.uniform(0, 2 * math.pi), math.atan2(qz, qw) + random.choice((-1, 1)) * math.radians(1.5)
    guesses.write(f"{i:04d} {x + 0.2 * math.cos(way)} {y + 0.2 * math.sin(way)} 0 0 0 {math.sin(half)} {math.cos(half)}\n")
    truth.write(rows[i])
    os.symlink(f"{sys.argv[1]}/{i:04d}.pcd", f"odd/{i:04d}.pcd")
PYTHON
"$gaussmap" pcd2map --planar "$data"/carmen_intel/*[02468].pcd -o even.gmap --resolution 0.05 >log
"$gaussmap" register odd even.gmap --poses guesses.tum --match-poses name --tum found.tum >log 2>&1
python3 - <<'PYTHON'
import math
def rows(name):
    return [list(map(float, line.split())) for line in open(name) if not line.startswith("#")]
found, truth = rows("found.tum"), rows("truth.tum")
distances = sorted(math.hypot(a[1] - b[1], a[2] - b[2]) for a, b in zip(found, truth))
turns = sorted(abs(math.degrees(math.remainder(2 * (math.atan2(a[6], a[7]) - math.atan2(b[6], b[7])), 2 * math.pi)))
               for a, b in zip(found, truth))
print(f"registered: {len(found)} of {len(truth)} scans")
for share in (0.5, 0.9, 0.95, 0.99):
    at = math.ceil(share * len(distances)) - 1
    print(f"{100 * share:.0f} %: {100 * distances[at]:.1f} cm, {turns[at]:.2f} degrees")
PYTHON
