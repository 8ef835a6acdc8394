#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Compressed maps of the simulated avenue: the size of the file, the Gaussians of the leaves per scale, and how far
# samples of the whole map lie from the true surface. Prints a table in Markdown.
# Usage: test/benchmark/compress.sh GAUSSMAP [as-in-paper]    as-in-paper: with limits of the cell error, eq. (6)
set -euo pipefail
[[ $# == 1 || ($# == 2 && $2 == as-in-paper) ]] || { sed -n '5p' "$0" | cut -c3- >&2; exit 2; }
gaussmap=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$gaussmap" simulate avenue -o "$work/world" >/dev/null
"$gaussmap" pcd2map "$work/world/scans" -o "$work/whole.gmap" >/dev/null

row() {  # name of the row, map
  "$gaussmap" info "$2" --json >"$work/info.json"
  "$gaussmap" hausdorff "$2" "$work/world/truth.ply" --leaves --samples 1000000 --at-least 1 --json >"$work/distances.json"
  python3 - "$1" "$work" <<'PY'
import json, sys
name, work = sys.argv[1:]
info, distances = (json.load(open(f"{work}/{file}.json")) for file in ("info", "distances"))
leaves = [scale["leaf_gaussians"] for scale in info["scales"]]
to_truth = distances["scales"][0]["all"]["forward"]
print(f"| {name} | {info['bytes'] / 1e6:.1f} MB | {' / '.join(map(str, leaves))} |"
      f" {to_truth['q95']:.2g} m | {to_truth['mean']:.2g} m |")
PY
}
if (($# == 2)); then limit=--max-cell-error limits=(300 1000 3000 10000) how=(--as-in-paper); else
  limit=--max-error limits=(0.1 0.15 0.5 1) how=()
fi
echo "| \`$limit\` | file | Gaussians of the leaves: 0.1 / 1 / 10 m cells | 95 % | mean |"
echo "|---|---|---|---|---|"
row "not compressed" "$work/whole.gmap"
for error in "${limits[@]}"; do
  "$gaussmap" compress "$work/whole.gmap" -o "$work/small.gmap" "${how[@]}" $limit "$error" --force >/dev/null
  row "$error" "$work/small.gmap"
done
