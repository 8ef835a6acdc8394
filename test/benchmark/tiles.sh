#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures a map that is larger than its memory limit. Simulates points over a square kilometre and builds a map of them
# (0.2 m, 3 scales, ratio 5) with and without --max-memory. Compares peak memory, seconds and bytes of the files, then
# loads boxes of 50 m from the map. Needs GNU time.
# Usage: test/benchmark/tiles.sh BUILD [POINTS] [MEMORY] [BUDGET]
set -euo pipefail
(($# >= 1)) || { sed -n '3,6p' "$0" >&2; exit 2; }
build=$1 points=${2:-60000000} memory=${3:-200M} budget=${4:-3}
work=$(mktemp -d -p "${TMPDIR:-/tmp}")
trap 'rm -rf "$work"' EXIT
"$build/test/benchmark/gaussmap_benchmark" wide-scans "$work/scans" "$points"
options=(--frame map --resolution 0.2 --ratio 5 --scales 3 --budget "$budget" --no-curves)
scan=$(find "$work/scans" -name '*.pcd' -printf '%s\n' | sort -n | tail -1)
echo "$points points, $(find "$work/scans" -name '*.pcd' | wc -l) scans of up to $((scan / 1000)) kB, budget $budget"
measure() {  # NAME OPTION...: prints peak memory [kB] and seconds
  /usr/bin/time -f '%M %e' -o "$work/time" "$build/apps/gaussmap" pcd2map "$work/scans" -o "$work/$1.gmap" \
    "${options[@]}" "${@:2}" >"$work/said"
  cat "$work/time"
}
read -r all_memory all_seconds < <(measure whole)
read -r tiled_memory tiled_seconds < <(measure tiled --max-memory "$memory")
cat "$work/said"
echo "no limit:            $((all_memory / 1000)) MB, $all_seconds s"
echo "--max-memory $memory:   $((tiled_memory / 1000)) MB, $tiled_seconds s ($(awk "BEGIN { printf \"%.2f\", $tiled_seconds / $all_seconds }") times)"
cmp "$work/whole.gmap" "$work/tiled.gmap" && echo "both files are identical"
"$build/test/benchmark/gaussmap_benchmark" box-load "$work/whole.gmap" 50
