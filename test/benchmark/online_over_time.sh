#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Repeats the experiments of Yguel et al. 2009, sec. 6. Builds an on-line map of the first N scans, with and without
# refinement, and measures the distances from samples of each scale to the reference. The cell sides are RESOLUTION, 10
# times and 100 times that.
# Usage: online_over_time.sh GAUSSMAP SCANS REFERENCE RESOLUTION N... (REFERENCE: a cloud, a mesh, or the scans)
set -euo pipefail
(($# >= 5)) || { sed -n "s|^# Usage: |usage: |p" "$0" >&2; exit 2; }
gaussmap=$1 scans=$2 reference=$3 resolution=$4
shift 4

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mapfile -t files < <(find "$scans" -maxdepth 1 -name '*.pcd' | sort -V)
printf '%6s %-12s %6s %10s %9s %9s %9s\n' scans "" scale Gaussians "99 %" "95 %" mean
for n in "$@"; do
  for refine in 0 1; do
    "$gaussmap" pcd2map "${files[@]:0:n}" -o "$folder/map.gmap" --force --online --resolution "$resolution" \
      --refine-every "$refine" --budget 4 >/dev/null
    title=$( ((refine)) && echo refined || echo "one per cell")
    for scale in 0 1 2; do
      count=$("$gaussmap" info "$folder/map.gmap" | awk -v s=$scale '$1 == s { print $4 }')
      distances=$("$gaussmap" hausdorff "$folder/map.gmap" "$reference" --scale $scale |
        awk '$2 == "all" && /map->ref/ { print $5, $6, $7 }')
      # shellcheck disable=SC2086
      printf '%6s %-12s %6s %10s %9s %9s %9s\n' "$n" "$title" $scale "$count" $distances
    done
  done
done
