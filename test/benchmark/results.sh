#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures everything, rewrites test/benchmark/RESULTS.md and the table of the README. Needs python3, and pcl-tools for
# the whole commands.
# Usage: test/benchmark/results.sh BUILD DATA [speed]
#   (BUILD configured with -DGAUSSMAP_BUILD_BENCHMARKS=ON; speed: only the table beside the peers)
set -euo pipefail
(($# == 2)) || [[ $# == 3 && $3 == speed ]] || { sed -n '3,6p' "$0" >&2; exit 2; }
build=$1 data=$2
here=$(dirname "$0")
new=$(mktemp)
trap 'rm -f "$new"' EXIT
accuracy() {
  cat <<'TEXT'
# Measured

Written by `test/benchmark/results.sh BUILD DATA`; no figure is typed by hand. Times are of a machine with two cores;
compare ratios, not seconds.

## Beside its peers

`gaussmap_benchmark table --growth --data DATA`: everything in the same run, every measurement in a process of its own;
the fastest of five runs in random order (three with more than ten million points, one on line; of registration the mean
of all starts). The README has the shorter half of this table.

<!-- benchmark: begin -->
<!-- benchmark: end -->

## Refinement: accuracy at equal numbers of Gaussians

`gaussmap_benchmark refinement-table --data DATA`: distances [m] from samples of the coarsest scale (100,000 by volume, at least 30
a Gaussian, within the box of its finest cells) to the truth, and the mean the other way; means of three seeds, the worst
in brackets. 'Paper's method' is Algorithm 2 as printed, 'parent seed' puts the new cluster at the same datum, but with
the covariance of the cluster that it leaves. 'Uniform grid' has one Gaussian in each of as many cells. The plain street
has the same kinds of things as the simulated street, but fewer trees and cars and no relief on the fronts.

TEXT
  "$build/test/benchmark/gaussmap_benchmark" refinement-table --data "$data"
  cat <<'TEXT'

## Maps of real scans

`test/benchmark/datasets.sh BUILD/apps/gaussmap BUILD/test/benchmark/gaussmap_benchmark DATA`: distances [m, feet for
autzen] between samples of the map (100,000 by volume, at least 30 a Gaussian) and the merged cloud it was made of;
budget 1 = one Gaussian per cell, 3 = refined to three times as many. Bytes are compressed tiles of the scale. The sum
of weights is the number of accepted points at every scale (the script stops if not).

TEXT
  "$here/datasets.sh" "$build/apps/gaussmap" "$build/test/benchmark/gaussmap_benchmark" "$data"
}
if (($# == 2)); then
  accuracy >"$new"
  cp "$new" "$here/RESULTS.md"
fi
"$build/test/benchmark/gaussmap_benchmark" table --growth --data "$data" --json "$new"
"$here/readme_table.py" "$new" "$here/RESULTS.md"
"$here/readme_table.py" "$new" "$here/../../README.md" "20.0 M" "0.1 m" compressed
