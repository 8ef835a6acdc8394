#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures everything and rewrites the tables of README.md, docs/*.md and test/benchmark/RESULTS.md: see readme_table.py.
# Needs python3, and pcl-tools for the whole commands. What was measured stays in BUILD/figures.
# Usage: test/benchmark/results.sh BUILD DATA [speed | accuracy | papers | large | tables]
#   BUILD     configured with -DGAUSSMAP_BUILD_BENCHMARKS=ON; DATA: a folder with the data sets
#   speed     only the times beside peers
#   accuracy  only distances: refinement, real scans, compressed, merged and simplified maps, filters
#   papers    only docs/reproduction.md
#   large     only the map larger than memory (60 M points, 2 GB)
#   tables    measures nothing: writes the tables of what BUILD/figures has
set -euo pipefail
what=${3:-all}
{ (($# == 2 || $# == 3)) && [[ $what =~ ^(all|speed|accuracy|papers|large|tables)$ ]]; } || { sed -n '5,11p' "$0" | cut -c3- >&2; exit 2; }
build=$1 data=$2
here=$(dirname "$0")
gaussmap=$build/apps/gaussmap benchmark=$build/test/benchmark/gaussmap_benchmark figures=$build/figures
mkdir -p "$figures"

part() { [[ $what == "$1" || $what == all ]]; }
as_text() { echo '```text'; cat; echo '```'; }  # plain text in Markdown

if part speed; then
  "$benchmark" table --growth --data "$data" --json "$figures/table.json"
  "$benchmark" search "$data"/{kitti_6scans,mulran_kaist03_21scans,sim_hall_20scans} >"$figures/search.md"
  formats=$data/kitti_6scans_formats  # written by test/data/formats/same_scans/make.py
  [[ ! -d $formats ]] || "$benchmark" formats "$formats"/{pcd,bin,las,laz,ply}/* "$formats"/scans.{e57,bag} \
    "$formats"/{none,lz4,zstd}.mcap "$formats"/rosbag2/*.db3 | as_text >"$figures/formats.md"
fi
if part accuracy; then
  "$benchmark" refinement-table --data "$data" --json "$figures/refinement.json" | sed '/^### Overview/,$d' >"$figures/refinement.md"
  "$benchmark" filters "$data"/{kitti_6scans,rgbd_office_single,mulran_kaist03_21scans} --json "$figures/filters.json"
  "$here/compress.sh" "$gaussmap" >"$figures/compress.md"
  "$here/merge.sh" "$gaussmap" merge "$data/mulran_kaist03_21scans" "$data/mulran_kaist03_21scans/trajectory.tum" |
    sed -n '/^95 %/,/^scale 2/p' | as_text >"$figures/merge.md"
  "$here/merge.sh" "$gaussmap" simplify "$data/kitti_6scans" "$data/kitti_6scans" | sed -n '/^95 %/,$p' |
    as_text >"$figures/simplify.md"
  "$here/datasets.sh" "$gaussmap" "$benchmark" "$data" >"$figures/datasets.md"
fi
if part papers; then
  "$benchmark" papers --data "$data" --output "$here/../../docs/reproduction.md"
fi
if part large; then
  "$here/tiles.sh" "$build" | as_text >"$figures/tiles.md"
fi

arguments=()
for file in "$figures"/*.json; do
  [[ ! -e $file ]] || arguments+=("--$(basename "$file" .json)" "$file")
done
for file in "$figures"/*.md; do
  [[ ! -e $file ]] || arguments+=(--text "$(basename "$file" .md)=$file")
done
"$here/readme_table.py" "${arguments[@]}" "$here/../../README.md" "$here/RESULTS.md" "$here"/../../docs/*.md
