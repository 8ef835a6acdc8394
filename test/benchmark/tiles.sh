#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A map larger than its memory: simulated points spread over a square kilometre (0.2 m, 3 scales, ratio 5), built with
# and without --max-memory (peak memory, seconds, same bytes), then boxes of 50 m loaded from it. Needs GNU time.
# Usage: test/benchmark/tiles.sh BUILD [POINTS] [MEMORY] [BUDGET]
set -euo pipefail
(($# >= 1)) || { sed -n '3,5p' "$0" >&2; exit 2; }
build=$1 points=${2:-60000000} memory=${3:-200M} budget=${4:-3}
work=$(mktemp -d -p "${TMPDIR:-/tmp}")
trap 'rm -rf "$work"' EXIT
"$build/test/benchmark/gaussmap_benchmark" wide-scans "$work/scans" "$points"
options=(--frame map --resolution 0.2 --ratio 5 --scales 3 --budget "$budget" --no-curves)
scan=$(find "$work/scans" -name '*.pcd' -printf '%s\n' | sort -n | tail -1)
echo "$points points, $(find "$work/scans" -name '*.pcd' | wc -l) scans of up to $((scan / 1000)) kB, budget $budget"
measure() {  # NAME OPTION...: peak memory [kB] and seconds
  /usr/bin/time -f '%M %e' -o "$work/time" "$build/apps/gaussmap" pcd2map "$work/scans" -o "$work/$1.gmap" \
    "${options[@]}" "${@:2}" >"$work/said"
  cat "$work/time"
}
read -r all_memory all_seconds < <(measure whole)
read -r tiled_memory tiled_seconds < <(measure tiled --max-memory "$memory")
cat "$work/said"
echo "no limit:            $((all_memory / 1000)) MB, $all_seconds s"
echo "--max-memory $memory:   $((tiled_memory / 1000)) MB, $tiled_seconds s ($(awk "BEGIN { printf \"%.2f\", $tiled_seconds / $all_seconds }") times)"
cmp "$work/whole.gmap" "$work/tiled.gmap" && echo "the same bytes"
"$build/test/benchmark/gaussmap_benchmark" box-load "$work/whole.gmap" 50
