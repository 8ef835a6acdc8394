#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Hausdorff distance of two clouds of a million points: gaussmap hausdorff (all figures, and --max-only, which finds the
# same maxima) beside pcl_compute_hausdorff (package pcl-tools); in turn, shortest and median of N wall times of the
# whole commands. Fails if the maxima differ by more than PCL's floats do.
# Usage: test/benchmark/hausdorff.sh BUILD [POINTS] [RUNS]
set -euo pipefail
(($# >= 1)) || { sed -n '3,6p' "$0" >&2; exit 2; }
build=$1 points=${2:-1000000} runs=${3:-5}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
gaussmap=$build/apps/gaussmap large_scan=$build/test/benchmark/gaussmap_large_scan
"$large_scan" "$work/a.pcd" "$points"
TIMEFORMAT=%R
timed() { { time "$@" >"$work/out" 2>&1; } 2>&1; }
rank() { sort -n "$1" | sed -n "$2p"; }                             # file, which
ratio() { awk "BEGIN { printf \"%.1f\", $1 / $2 }"; }
echo "| second cloud | maximum | | shortest | median | pcl / ours, shortest | median |"
echo "|---|---|---|---|---|---|---|"
compare() {  # its first scan, title
  "$large_scan" "$work/b.pcd" "$points" "$1"
  rm -f "$work"/*.times
  for ((run = 0; run < runs; ++run)); do
    timed pcl_compute_hausdorff "$work/a.pcd" "$work/b.pcd" >>"$work/pcl.times"
    pcl=$(sed -n 's/.*Hausdorff Distance: \([0-9.e+-]*\).*/\1/p' "$work/out")
    timed "$gaussmap" hausdorff "$work/a.pcd" "$work/b.pcd" --frame map --json >>"$work/all.times"
    all=$(awk -F '[ ,]+' '/"hausdorff"/ { print $3 }' "$work/out")
    timed "$gaussmap" hausdorff "$work/a.pcd" "$work/b.pcd" --frame map --json --max-only >>"$work/max.times"
    max=$(awk -F '[ ,]+' '/"hausdorff"/ { print $3 }' "$work/out")
  done
  [[ $all == "$max" ]] || { echo "maxima differ: all $all, --max-only $max" >&2; exit 1; }
  # PCL prints six decimals of a float.
  awk "BEGIN { d = $pcl - $all; exit !((d < 0 ? -d : d) <= 1e-6 + 1e-6 * $all) }" ||
    { echo "maxima differ: pcl $pcl, gaussmap $all" >&2; exit 1; }
  local middle=$(((runs + 1) / 2))
  for program in pcl all max; do
    local name
    case $program in
      pcl) name=pcl_compute_hausdorff ;;
      all) name="gaussmap hausdorff" ;;
      max) name="gaussmap hausdorff --max-only" ;;
    esac
    shortest=$(rank "$work/$program.times" 1) median=$(rank "$work/$program.times" $middle)
    echo "| $2 | $([[ $program == pcl ]] && echo "$pcl" || echo "$all") | $name | $shortest s | $median s |" \
      "$(ratio "$(rank "$work/pcl.times" 1)" "$shortest") | $(ratio "$(rank "$work/pcl.times" $middle)" "$median") |"
  done
}
compare 9 "the next metres of the drive"
compare 80 "the same places, other noise"
