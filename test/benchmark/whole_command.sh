#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Whole commands on one big binary PCD: pcd2map (3 scales, ratio 10, budget 1, one thread) beside pcl_voxel_grid
# (package pcl-tools) with the same leaf; in turn, median of N wall times.
# Usage: test/benchmark/whole_command.sh BUILD [POINTS] [RUNS]
set -euo pipefail
(($# >= 1)) || { sed -n '3,5p' "$0" >&2; exit 2; }
build=$1 points=${2:-5000000} runs=${3:-5}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$build/test/benchmark/gaussmap_large_scan" "$work/big.pcd" "$points"
TIMEFORMAT=%R
timed() { { time "$@" >/dev/null 2>&1; } 2>&1; }
median() { sort -n | sed -n "$(((runs + 1) / 2))p"; }
echo "| leaf | pcd2map | pcl_voxel_grid | ratio |"
echo "|---|---|---|---|"
for leaf in 0.1 0.2 1; do
  : >"$work/ours" && : >"$work/pcl"
  for ((run = 0; run < runs; ++run)); do
    timed "$build/apps/gaussmap" pcd2map "$work/big.pcd" -o "$work/big.gmap" --force --budget 1 --resolution "$leaf" \
      --frame map --threads 1 >>"$work/ours"
    timed pcl_voxel_grid "$work/big.pcd" "$work/out.pcd" -leaf "$leaf,$leaf,$leaf" >>"$work/pcl"
  done
  ours=$(median <"$work/ours") pcl=$(median <"$work/pcl")
  echo "| $leaf m | $ours s | $pcl s | $(awk "BEGIN { printf \"%.1f\", $pcl / $ours }") |"
done
