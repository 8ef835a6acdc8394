#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures everything and rewrites test/benchmark/RESULTS.md. Needs python3, and pcl-tools for the whole commands.
# Usage: test/benchmark/results.sh BUILD DATA   (BUILD configured with -DGAUSSMAP_BUILD_BENCHMARKS=ON)
set -euo pipefail
(($# == 2)) || { sed -n '3,4p' "$0" >&2; exit 2; }
build=$1 data=$2
here=$(dirname "$0")
new=$(mktemp)
trap 'rm -f "$new"' EXIT
{
  cat <<'TEXT'
# Measured

Written by `test/benchmark/results.sh BUILD DATA`; no figure is typed by hand. Times are of a machine with two cores;
compare ratios, not seconds.

## Building the finest scale

`gaussmap_benchmark --scans DATA/kitti_6scans --benchmark_repetitions=5`: one thread, 746 k points of six lidar scans,
and 5 M simulated points in packet order. MomentGrid = the exact sums; Gaussians = sums, key order and the
eigen-decomposition of every cell, which `pcl::VoxelGridCovariance` makes too. Numbers are the peer's CPU time over ours.

```
TEXT
  "$build/test/benchmark/gaussmap_benchmark" --scans "$data/kitti_6scans" --benchmark_repetitions=5 \
    --benchmark_report_aggregates_only=true --benchmark_color=false 2>/dev/null | grep -E 'Times of|input|scans/[0-9.]+m |street/[0-9.]+m '
  cat <<'TEXT'
```

## Whole command

`test/benchmark/whole_command.sh BUILD`: 5 M points, one binary PCD; pcd2map makes three scales and a map file.

TEXT
  "$here/whole_command.sh" "$build"
  cat <<'TEXT'

## Hausdorff distance of two clouds

`test/benchmark/hausdorff.sh BUILD`: two binary PCD files of a million points each; whole commands on all processors
(PCL uses one). The script stops if the maxima differ by more than PCL's floats and printed decimals.

TEXT
  "$here/hausdorff.sh" "$build"
  cat <<'TEXT'

## Refinement: time

`gaussmap_refinement_speed`: the simulated street to 3.4 Gaussians per cell, one thread, shortest of five runs. Clustering
alone stands beside scalar code with Eigen objects, logarithms and a cheapest partner for each cluster.

TEXT
  "$build/test/benchmark/gaussmap_refinement_speed"
  cat <<'TEXT'

## Refinement: accuracy at equal numbers of Gaussians

`gaussmap_refinement_table --data DATA`: distances [m] from samples of the coarsest scale (100,000 by volume, at least 30
a Gaussian, within the box of its finest cells) to the truth, and the mean the other way; means of three seeds, the worst
in brackets. 'Paper's method' is Algorithm 2 as printed, 'parent seed' puts the new cluster at the same datum, but with
the covariance of the cluster that it leaves. 'Uniform grid' has one Gaussian in each of as many cells. The plain street
has the same kinds of things as the simulated street, but fewer trees and cars and no relief on the fronts.

TEXT
  "$build/test/benchmark/gaussmap_refinement_table" --data "$data"
  cat <<'TEXT'

## Maps of real scans

`test/benchmark/datasets.sh BUILD/apps/gaussmap BUILD/test/benchmark/gaussmap_reference DATA`: distances [m, feet for
autzen] between samples of the map (100,000 by volume, at least 30 a Gaussian) and the merged cloud it was made of;
budget 1 = one Gaussian per cell, 3 = refined to three times as many. Bytes are compressed tiles of the scale. The sum
of weights is the number of accepted points at every scale (the script stops if not).

TEXT
  "$here/datasets.sh" "$build/apps/gaussmap" "$build/test/benchmark/gaussmap_reference" "$data"
} >"$new"
cp "$new" "$here/RESULTS.md"
