#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the main job on real data. Builds a map of every dataset with and without refinement, and prints a table: sizes,
# and at every scale the distances to the merged cloud of the dataset. Stops if the weights of a scale do not add up to
# the accepted points. Then prints the build times and compares the finest scales with a brute-force reference.
# Usage: test/benchmark/datasets.sh GAUSSMAP BENCHMARK DATA > table.md
#   GAUSSMAP: the command line; BENCHMARK: the gaussmap_benchmark program; DATA: a folder with the datasets
set -euo pipefail
(($# == 3)) || { sed -n '3,7p' "$0" >&2; exit 2; }
gaussmap=$1 benchmark=$2 data=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# name | options of pcd2map | options for reading the scans (also for hausdorff and the reference) | files
datasets=(
  "kitti_6scans|--resolution 0.1||kitti_6scans"
  "mulran_kaist03_21scans|--resolution 0.1||mulran_kaist03_21scans"
  "rgbd_office_5frames|--resolution 0.02||rgbd_office_5frames"
  "dtk_indoor_3scans|--resolution 0.1||dtk_indoor_3scans"
  "sim_hall_20scans|--resolution 0.1||sim_hall_20scans"
  "stanford_bunny_10scans|--resolution 0.002||stanford_bunny_10scans"
  "autzen_aerial (double)|--resolution 3|--frame map|autzen_aerial/autzen_double_corner.pcd"
)

field() { python3 -c "import json,sys; d=json.load(open('$1')); print($2)"; }

echo "| dataset | budget | scale | cell | cells | Gaussians | bytes | map to cloud 99 % | 95 % | mean | 2 sigma 99 % | 95 % | cloud to map 99 % | 95 % | mean |"
echo "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
for dataset in "${datasets[@]}"; do
  IFS='|' read -r name building reading files <<<"$dataset"
  for budget in 1 3; do
    map=$work/map.gmap
    # shellcheck disable=SC2086
    "$gaussmap" pcd2map "$data/$files" -o "$map" --force --budget "$budget" $building $reading --json >"$work/build.json"
    "$gaussmap" info "$map" --json >"$work/info.json"
    "$gaussmap" export "$map" "$work/map.pcd" --force >/dev/null
    # shellcheck disable=SC2086
    "$gaussmap" hausdorff "$map" "$data/$files" $reading --json >"$work/hausdorff.json"
    # shellcheck disable=SC2086
    ((budget > 1)) || "$benchmark" reference "$map" "$data/$files" ${reading:+map} >"$work/reference.txt"
    python3 - "$name" "$budget" "$work" <<'PY'
import json, sys
name, budget, work = sys.argv[1:]
build, info, hausdorff = (json.load(open(f"{work}/{f}.json")) for f in ("build", "info", "hausdorff"))
accepted = build["points"]["accepted"]
for scale, h in zip(info["scales"], hausdorff["scales"]):
    if abs(scale["weight"] - accepted) > 1e-9 * accepted:
        sys.exit(f"{name}, scale {scale['scale']}: weight {scale['weight']} is not the {accepted} accepted points")
    f, b, s = h["all"]["forward"], h["all"]["backward"], h["within_two_sigma"]["forward"]
    cell = f"{scale['cell_side']:g}"
    print(f"| {name} | {budget} | {scale['scale']} | {cell} | {scale['cells']} | {scale['gaussians']} | {scale['bytes']} |"
          + "".join(f" {v:.3g} |" for v in (f["q99"], f["q95"], f["mean"], s["q99"], s["q95"], b["q99"], b["q95"], b["mean"])))
PY
  done
  printf '%s: %s; budget 3 built in %.2f s\n' "$name" "$(cat "$work/reference.txt")" "$(field "$work/build.json" 'd["seconds"]')" >>"$work/checks.txt"
done
echo
echo "The finest scale compared with a brute-force reference (all cells found, equal counts, largest differences in cell sides):"
echo
sed 's/^/- /' "$work/checks.txt"
