#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs, builds, and runs the main job on a simulated scene: scans -> map, with and without refinement -> how far
# each scale is from the truth. Usage: apps/demo.sh
set -euo pipefail
cd "$(dirname "$0")/.."

./cmake/install-deps.sh
launcher=$(command -v ccache || true)
cmake -S . -B build/demo -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" \
  -DGAUSSMAP_BUILD_PCL=OFF -DGAUSSMAP_BUILD_TESTS=OFF >/dev/null
cmake --build build/demo -j 2 | tail -n 1
gaussmap=build/demo/apps/gaussmap

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
echo
"$gaussmap" simulate -o "$folder" | sed "s|$folder|scene|"
for budget in 1 3; do
  "$gaussmap" pcd2map "$folder/scans" -o "$folder/budget$budget.gmap" --budget "$budget" | sed "s|$folder/||"
done

echo
echo "How far samples of the map lie from the truth, and the truth from them [m]; scale 0 = 0.1 m cells, 2 = 10 m:"
echo
for budget in 1 3; do
  [ "$budget" = 1 ] && echo "one Gaussian per cell" || echo "refined to $budget times as many at the coarse scales"
  "$gaussmap" hausdorff "$folder/budget$budget.gmap" "$folder/truth.pcd" --frame map
  echo
done
