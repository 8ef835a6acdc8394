#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs all benchmarks and rewrites test/benchmark/RESULTS.md and the table of the README. Needs python3, and pcl-tools
# to compare whole commands.
# Usage: test/benchmark/results.sh BUILD DATA [speed]
#   (BUILD: configured with -DGAUSSMAP_BUILD_BENCHMARKS=ON; speed: only the table that compares with other programs)
set -euo pipefail
(($# == 2)) || [[ $# == 3 && $3 == speed ]] || { sed -n '3,6p' "$0" >&2; exit 2; }
build=$1 data=$2
here=$(dirname "$0")
new=$(mktemp)
trap 'rm -f "$new"' EXIT
accuracy() {
  cat <<'TEXT'
# Benchmark results

`test/benchmark/results.sh BUILD DATA` writes this file; no number is typed by hand. The times are from a machine with
two cores. Compare ratios, not seconds.

## Comparison with other programs

`gaussmap_benchmark table --growth --data DATA` measures everything in the same run, each measurement in a separate
process. A time is the fastest of five runs in random order (three runs with more than ten million points, one run for
on-line mapping). The time of a registration is the mean over all starts. The README shows a part of this table.

<!-- benchmark: begin -->
<!-- benchmark: end -->

## Refinement: accuracy at equal numbers of Gaussians

`gaussmap_benchmark refinement-table --data DATA` measures the distances [m] from samples of the coarsest scale to the
true surfaces, and the mean distance in the other direction. There are 100,000 samples by volume, at least 30 per
Gaussian, within the box of its finest cells. Values are means over three seeds; the worst value is in brackets.
"Paper's method" is Algorithm 2 as printed. "Parent seed" starts the new cluster at the same input Gaussian, but with
the covariance of the cluster that the input Gaussian leaves. "Uniform grid" has the same number of cells with one Gaussian
each. The plain street contains the same kinds of objects as the simulated street, but fewer trees and cars, and its
fronts have no relief.

TEXT
  "$build/test/benchmark/gaussmap_benchmark" refinement-table --data "$data"
  cat <<'TEXT'

## Maps of real scans

`test/benchmark/datasets.sh BUILD/apps/gaussmap BUILD/test/benchmark/gaussmap_benchmark DATA` measures the distances [m;
feet for autzen] between samples of the map (100,000 by volume, at least 30 per Gaussian) and the merged cloud that the
map was built from. Budget 1 is one Gaussian per cell, budget 3 is refined to three times as many. Bytes are those of
the compressed tiles of the scale. At every scale, the sum of the weights is the number of accepted points; the script
stops if it is not.

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
