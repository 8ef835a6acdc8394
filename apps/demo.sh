#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the packages, builds gaussmap, and runs the main job on a simulated street. It builds maps with several
# budgets and both methods, and prints the distance of each map's coarsest scale from the true surfaces. It writes
# demo/street.gmap, demo/curve.svg (error against the number of Gaussians), and two pictures from above with one and
# with four Gaussians per cell: demo/map.svg (the street) and demo/crossing.svg (60 m of it).
# Usage: apps/demo.sh
set -euo pipefail
cd "$(dirname "$0")/.."

./cmake/install-deps.sh
launcher=$(command -v ccache || true)
cmake --preset demo -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" >/dev/null
cmake --build build/demo -j 2 | tail -n 1
gaussmap=build/demo/apps/gaussmap

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
echo
"$gaussmap" simulate street -o "$folder" | sed "s|$folder: ||"
"$gaussmap" pcd2map "$folder/scans" -o "$folder/one.gmap" --budget 1 | sed "s|$folder/||"

echo
echo "Cells of 10 m: distances from samples of the map to the true surfaces [m]"
echo
printf '%-34s %9s %10s %8s %8s %8s\n' "" Gaussians "file size" "99 %" "95 %" mean
row() {  # title, map
  local distances info
  distances=$("$gaussmap" hausdorff "$2" "$folder/truth.pcd" --frame map --scale 2 | awk '$2 == "all" && /map->ref/ { print $5, $6, $7 }')
  info=$("$gaussmap" info "$2" | awk '$1 == 2 { print $4 }')
  # shellcheck disable=SC2086
  printf '%-34s %9s %10s %8s %8s %8s\n' "$1" "$info" "$(stat -c %s "$2" | awk '{ printf "%.1f MB", $1 / 1e6 }')" $distances
}
row "one per cell" "$folder/one.gmap"
for method in insert agglomerate; do
  for budget in 2 3.4 4; do
    "$gaussmap" refine "$folder/one.gmap" -o "$folder/$method$budget.gmap" --method $method --budget $budget >/dev/null
    case $method in
      insert) title="$budget per cell, insertion" ;;
      *) title="$budget per cell, agglomeration" ;;
    esac
    row "$title" "$folder/$method$budget.gmap"
  done
done

mkdir -p demo
cp "$folder/agglomerate4.gmap" demo/street.gmap
"$gaussmap" info demo/street.gmap --plot demo/curve.svg --force >/dev/null
"$gaussmap" draw "$folder/one.gmap" demo/street.gmap -o demo/map.svg --force >/dev/null
"$gaussmap" draw "$folder/one.gmap" demo/street.gmap -o demo/crossing.svg --box -30 -32 30 18 --force >/dev/null
echo
echo "written: demo/street.gmap, demo/curve.svg, demo/map.svg, demo/crossing.svg"
