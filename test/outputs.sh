#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Prints the SHA-256 of what 83 commands write and print, to see that a change of the code changes no output.
# Usage: test/outputs.sh GAUSSMAP DATA > FILE      GAUSSMAP: the program; DATA: a folder of data sets (see below)
# Then: diff OLD NEW. Times are left out of what is printed.
set -uo pipefail
[[ $# == 2 ]] || { sed -n '3,5p' "$0" >&2; exit 2; }
program=$(realpath "$1") data=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
ln -s "$data" data
count=0
# run NAME OUTPUT... -- ARGUMENTS...
run() {
  local name=$1 outputs=()
  shift
  while [[ $1 != -- ]]; do outputs+=("$1"); shift; done
  shift
  "$program" "$@" > "$work/printed" 2>&1
  local code=$?
  sed -E -i 's/"(seconds|time|memory)": [-+.e0-9]+/"\1": 0/; s/, [0-9.e-]+ s$//; s/in [0-9.e-]+ s\b//' "$work/printed"
  local sum
  sum=$({ cat printed; for output in "${outputs[@]}"; do
    if [[ -d $output ]]; then find "$output" -type f | LC_ALL=C sort | while read -r file; do echo "$file"; cat "$file"; done
    else cat "$output"; fi; done; } | sha256sum | cut -d' ' -f1)
  echo "$sum $code $name"
  [[ $code == 0 || $name == wrong_* ]] || { echo "-- $name failed:" >&2; cat printed >&2; }
  count=$((count + 1))
}
map() { local name=$1; shift; run "$name" "$name.gmap" -- "$@" -o "$name.gmap" --json; }

# Simulated worlds.
run simulate_corner corner -- simulate corner -o corner
run simulate_street street -- simulate street -o street --scans 6 --moving
run simulate_avenue avenue -- simulate avenue -o avenue --scans 4 --seed 7
run simulate_hall hall -- simulate hall -o hall --scans 6
run simulate_plan plan -- simulate plan -o plan --scans 40
# Building, each budget and method.
map one pcd2map street/scans --budget 1
map default pcd2map street/scans
map insert pcd2map street/scans --method insert --budget 2 --seed 3
map runnalls pcd2map street/scans --cost runnalls
map bytes pcd2map avenue/scans --max-bytes 9M
map error pcd2map avenue/scans --max-error 0.3
map limit pcd2map avenue/scans --max-gaussians 1=40k --max-gaussians 2=2k
map grid pcd2map hall/scans --resolution 0.07 --ratio 4 --scales 4 --noise 0.004 --max-range 15 --no-curves
map memory pcd2map street/scans --max-memory 4M
map frame pcd2map data/octomap_geb079/geb079_occupied_8cm.pcd --frame map --resolution 0.24 --ratio 4
map kitti pcd2map data/kitti_6scans --resolution 0.2
map mulran pcd2map data/mulran_kaist03_21scans --resolution 0.5 --poses data/mulran_kaist03_21scans/trajectory.tum
map office pcd2map data/rgbd_office_5frames --resolution 0.02
map bunny pcd2map data/stanford_bunny_10scans --resolution 0.002
map aerial pcd2map data/autzen_aerial/autzen_double_corner.pcd --frame map --resolution 5
# On line.
run online online.gmap online.pcd -- pcd2map data/sim_hall_moving_box_12scans -o online.gmap --online --removed online.pcd --resolution 0.2 --json
map online_street pcd2map street/scans --online --refine-every 3
map online_paper pcd2map data/sim_hall_moving_box_12scans --online --learning-rate occupancy --occupancy-samples random --method insert --refine-cells 4 --refine-every 5 --occupancy-every 3 --resolution 0.2
map online_mulran pcd2map data/mulran_kaist03_21scans --online --resolution 0.4 --keep
map online_frame pcd2map data/octomap_geb079/geb079_occupied_8cm.pcd --online --frame map --resolution 0.24
map online_range pcd2map data/kitti_6scans --online --max-range 30 --max-ranges 20,40,60 --no-return-is-free 10 --look-back 2
# Update.
mkdir first second
for i in 0 1 2; do cp data/kitti_6scans/00000$i.pcd first; cp data/kitti_6scans/00000$((i + 3)).pcd second; done
map first pcd2map first --resolution 0.2 --budget 2
map second pcd2map second --resolution 0.2 --budget 2
cp first.gmap updated.gmap
run update updated.gmap -- pcd2map --update updated.gmap second --json
cp first.gmap updated1.gmap
run update_budget updated1.gmap -- pcd2map --update updated1.gmap second --budget 1 --json
# Maps to maps.
map refine_insert refine kitti.gmap --method insert --budget 1.7
map refine_cells refine first.gmap --method insert --budget 2 --seed 5
map refine refine one.gmap --budget 4
map refine_bytes refine grid.gmap --max-bytes 5M
map merge merge first.gmap second.gmap
map merge_resample merge first.gmap default.gmap --resample
map merge_moved merge first.gmap second.gmap --transform "0.5 0 0 0 0 0 1"
map transform transform kitti.gmap --transform "1.5 -2.25 0.3 0 0 0.2588190451025207 0.9659258262890683"
map transform_back transform transform.gmap --inverse --transform "1.5 -2.25 0.3 0 0 0.2588190451025207 0.9659258262890683" --pose-covariance "1e-4 1e-4 1e-4 1e-6 1e-6 1e-6"
map crop crop kitti.gmap --box -20 -20 20 20
map crop_polygon crop kitti.gmap --polygon 0 0 30 0 30 30 --outside
map simplify simplify default.gmap --budget 1.5
map simplify_error simplify default.gmap --max-error 0.4
map simplify_bytes simplify default.gmap --max-bytes 10500k
map compress compress default.gmap --max-error 0.15
map finish finish default.gmap
map finish_coarse finish kitti.gmap --finest-scale 1
run restore restored.gmap -- restore online.gmap online.pcd -o restored.gmap --json
run diff diff.pcd -- diff first.gmap second.gmap -o diff.pcd --json
run diff_scale -- diff first.gmap second.gmap --scale 1 --json
# Other outputs.
run tiles tiles -- tiles kitti.gmap -o tiles --json
run tiles_all tiles_all -- tiles default.gmap -o tiles_all --all-scales --size 50 --json
run tiles_back tiles_back.gmap -- tiles tiles_all -o tiles_back.gmap --json
run export_pcd e.pcd -- export default.gmap e.pcd
run export_ply e.ply -- export default.gmap e.ply --scale 1
run export_splats s.ply -- export kitti.gmap s.ply --as splats --scale 1
run export_points p.ply -- export kitti.gmap p.ply --as points --color normal
run export_vtp e.vtp -- export default.gmap e.vtp
run export_csv e.csv -- export default.gmap e.csv --scale 2
run import_pcd back.gmap -- finish e.pcd -o back.gmap --json
run draw draw.svg -- draw default.gmap kitti.gmap -o draw.svg
run info plot.svg -- info default.gmap --json --plot plot.svg
run info_online -- info online.gmap --json
run info_text -- info kitti.gmap
run clean cleaned removed.pcd merged.pcd -- clean data/sim_hall_moving_box_12scans -o cleaned --removed removed.pcd --merged merged.pcd --labels --json
run clean_street cleaned_street -- clean street/scans -o cleaned_street --labels --json
run segments s.pcd s.geojson s.csv -- segments plan/scans -o s.pcd -o s.geojson -o s.csv --walls plan/walls.pcd --json
run segments_intel i.pcd i.svg stats.csv -- segments data/carmen_intel/intel-corrected.log.gz -o i.pcd -o i.svg --every 4 --stats stats.csv --json
run segments_paper l.pcd -- segments data/carmen_csail -o l.pcd --every 3 --particles 30 --utility viewpoint-invariant --json
run segments_slice h.pcd -- segments hall/scans -o h.pcd --slice 0.9 1.1 --json
run register tum.txt -- register data/kitti_6scans/000002.pcd first.gmap --tum tum.txt --json
run register_map -- register second.gmap first.gmap --json
run register_street -- register street/scans default.gmap --json
run hausdorff -- hausdorff default.gmap street/truth.pcd --frame map --json
run hausdorff_scans -- hausdorff kitti.gmap data/kitti_6scans --scale 2 --json
run hausdorff_mesh err.pcd -- hausdorff default.gmap street/truth.ply --samples 20000 --scale 2 --write-errors err.pcd --json
run hausdorff_map -- hausdorff refine.gmap one.gmap --scale 1 --json
run held_out -- hausdorff first.gmap second --held-out --json
run hausdorff_max -- hausdorff data/sim_hall_20scans hall/truth.pcd --max-only --json
# Wrong use and bad data end in the same line.
head -c 2000 data/kitti_6scans/000000.pcd > cut.pcd
run wrong_cut -- pcd2map cut.pcd -o x.gmap
run wrong_budget -- pcd2map street/scans -o x.gmap --budget 0
run wrong_map -- info street/truth.pcd
run wrong_exists -- pcd2map street/scans -o one.gmap
echo "$count commands" >&2
