#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures merged and simplified maps.
# merge: builds maps of the two halves of a drive, the second half in a frame that is moved by a known pose, and merges
# them with that pose. Compares the result with a map of all scans in one frame with the same number of Gaussians: the
# distances from samples of each scale to the points of the scans, and the wall times of the commands (best of three).
# simplify: reduces a map with twenty Gaussians per coarse cell to a half, a quarter and a tenth of its Gaussians.
# Compares the result with refine to the same number: the distances from samples of the scale to the reference.
# as-in-paper: both with --as-in-paper (Yguel 2009, sec. 5.4), with its single settings, and with the defaults. Compares
# merged maps with a map of all scans, and simplified maps with a refined map, with as many Gaussians each.
# Usage: test/benchmark/merge.sh GAUSSMAP merge SCANS TRAJECTORY.tum
#        test/benchmark/merge.sh GAUSSMAP simplify SCANS REFERENCE   (REFERENCE: a cloud, a mesh, or the scans)
#        test/benchmark/merge.sh GAUSSMAP as-in-paper SCANS REFERENCE   (SCANS in one frame, with poses in their files)
set -euo pipefail
(($# == 4)) || { grep -A1 '^# Usage' "$0" | cut -c3- >&2; exit 2; }
gaussmap=$1 what=$2 scans=$3 other=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

gaussians() { "$gaussmap" info "$1" | awk -v s="$2" '$1 == s { print $4 }'; }  # map, scale
# map, scale, reference: the 95 % quantile and mean of the distances from samples of the scale
distances() { "$gaussmap" hausdorff "$1" "$3" --scale "$2" | awk '$2 == "all" && /map->ref/ { print $6, $7 }'; }
row() {  # title, pair of values, pair of values to compare with
  awk -v w="$1" -v a="$2" -v b="$3" 'BEGIN { split(a, p, " "); split(b, q, " ");
    printf "%-44s %8s %8s   %8s %8s   %+6.1f %% %+6.1f %%\n", w, p[1], p[2], q[1], q[2],
           100 * (p[1] / q[1] - 1), 100 * (p[2] / q[2] - 1) }'
}
# map, scale, reference: the 99 % and 95 % quantiles and mean of the distances from samples of the scale
quantiles() { "$gaussmap" hausdorff "$1" "$3" --scale "$2" | awk '$2 == "all" && /map->ref/ { print $5, $6, $7 }'; }
compare() {  # title, map, map to compare with, scale
  awk -v w="$1" -v n="$(gaussians "$2" "$4")" -v a="$(quantiles "$2" "$4" "$other")" \
    -v b="$(quantiles "$3" "$4" "$other")" 'BEGIN { split(a, p, " "); split(b, q, " ")
    printf "%-42s %7d %8s %8s %8s   %+6.1f %% %+6.1f %% %+6.1f %%\n", w, n, p[1], p[2], p[3],
           100 * (p[1] / q[1] - 1), 100 * (p[2] / q[2] - 1), 100 * (p[3] / q[3] - 1) }'
}
shortest() {  # command...: the shortest time of three runs
  local TIMEFORMAT=%R
  for _ in 1 2 3; do { time "$@" >/dev/null; } 2>&1; done | sort -n | head -1
}

if [[ $what == merge ]]; then
  mapfile -t files < <(find "$scans" -maxdepth 1 -name '*.pcd' | sort -V)
  half=$((${#files[@]} / 2))
  pose="12.345 -7.89 1.23 0.02 -0.03 0.35 0.936055020"  # pose of the second frame in the first frame
  awk -v pose="$pose" -v skip=$half 'BEGIN { split(pose, t, " ") }
    function turn(x, y, z, w, px, py, pz) {  # rotates p by a quaternion; the result is v
      v[1] = (1-2*(y*y+z*z))*px + 2*(x*y-z*w)*py + 2*(x*z+y*w)*pz
      v[2] = 2*(x*y+z*w)*px + (1-2*(x*x+z*z))*py + 2*(y*z-x*w)*pz
      v[3] = 2*(x*z-y*w)*px + 2*(y*z+x*w)*py + (1-2*(x*x+y*y))*pz }
    /^#/ || NF == 0 || ++n <= skip { next }
    { x = -t[4]; y = -t[5]; z = -t[6]; w = t[7]  # the inverse rotation
      turn(x, y, z, w, $2 - t[1], $3 - t[2], $4 - t[3])
      printf "%s %.12g %.12g %.12g %.12g %.12g %.12g %.12g\n", $1, v[1], v[2], v[3],
             w*$5 + x*$8 + y*$7 - z*$6, w*$6 - x*$7 + y*$8 + z*$5,
             w*$7 + x*$6 - y*$5 + z*$8, w*$8 - x*$5 - y*$6 - z*$7 }
    ' "$other" >"$work/moved.tum"
  "$gaussmap" pcd2map "${files[@]:0:half}" -o "$work/a.gmap"
  "$gaussmap" pcd2map "${files[@]:half}" --poses "$work/moved.tum" -o "$work/b.gmap"
  merge() { "$gaussmap" merge "$work/a.gmap" "$work/b.gmap" --transform "$pose" -o "$work/ab.gmap" --force; }
  merge
  rebuild() { "$gaussmap" pcd2map "$scans" -o "$work/one.gmap" --force "$@"; }
  limits=()
  for scale in 1 2; do limits+=(--max-gaussians "$scale=$(gaussians "$work/ab.gmap" $scale)"); done
  rebuild "${limits[@]}"
  printf '\n%-44s %17s   %17s   %s\n' "95 %, mean [m] to the scans' points" merged "in one frame" difference
  for scale in 0 1 2; do
    row "scale $scale, $(gaussians "$work/ab.gmap" $scale) and $(gaussians "$work/one.gmap" $scale) Gaussians" \
      "$(distances "$work/ab.gmap" $scale "$scans")" "$(distances "$work/one.gmap" $scale "$scans")"
  done
  merging=$(shortest merge) rebuilding=$(shortest rebuild "${limits[@]}")
  awk -v m="$merging" -v r="$rebuilding" 'BEGIN { printf "merge %.2f s, pcd2map %.2f s: %.1f %%\n", m, r, 100 * m / r }'
elif [[ $what == simplify ]]; then
  "$gaussmap" pcd2map "$scans" -o "$work/whole.gmap" --budget 20
  printf '\n%-44s %17s   %17s   %s\n' "95 %, mean [m] to the reference" simplified refined difference
  for scale in 1 2; do
    all=$(gaussians "$work/whole.gmap" $scale)
    cells=$("$gaussmap" info "$work/whole.gmap" | awk -v s=$scale '$1 == s { print $3 }')
    for part in 2 4 10; do
      count=$((all / part > cells ? all / part : cells))
      "$gaussmap" simplify "$work/whole.gmap" -o "$work/simple.gmap" --force --max-gaussians $scale=$count >/dev/null
      "$gaussmap" refine "$work/whole.gmap" -o "$work/refined.gmap" --force \
        --max-gaussians 1="$(gaussians "$work/simple.gmap" 1)" \
        --max-gaussians 2="$(gaussians "$work/simple.gmap" 2)" >/dev/null
      row "scale $scale, $count of $all Gaussians" "$(distances "$work/simple.gmap" $scale "$other")" \
        "$(distances "$work/refined.gmap" $scale "$other")"
    done
  done
elif [[ $what == as-in-paper ]]; then
  mapfile -t files < <(find "$scans" -maxdepth 1 -name '*.pcd' | sort -V)
  half=$((${#files[@]} / 2))
  "$gaussmap" pcd2map "${files[@]:0:half}" -o "$work/a.gmap"
  "$gaussmap" pcd2map "${files[@]:half}" -o "$work/b.gmap"
  "$gaussmap" pcd2map "${files[@]}" -o "$work/all.gmap" --budget 20
  refined() {  # map with the numbers of Gaussians: a map of all scans with the same numbers
    local limits=() scale
    for scale in 1 2; do limits+=(--max-gaussians "$scale=$(gaussians "$1" $scale)"); done
    "$gaussmap" refine "$work/all.gmap" -o "$work/refined.gmap" --force "${limits[@]}" >/dev/null
  }
  printf '\n%-42s %7s %8s %8s %8s   %s\n' "two halves merged" number "99 %" "95 %" "mean [m]" \
    "compared with all scans"
  for scale in 1 2; do
    for how in "" "--as-in-paper" "--as-in-paper --smooth=false" "--as-in-paper --cost volume" \
      "--as-in-paper --method finer-scales"; do
      # shellcheck disable=SC2086
      "$gaussmap" merge "$work/a.gmap" "$work/b.gmap" -o "$work/ab.gmap" --force $how >/dev/null
      refined "$work/ab.gmap"
      compare "scale $scale, ${how:-default}" "$work/ab.gmap" "$work/refined.gmap" $scale
    done
  done
  printf '\n%-42s %7s %8s %8s %8s   %s\n' "20 Gaussians per cell simplified to 4" number "99 %" "95 %" "mean [m]" \
    "compared with refine"
  for scale in 1 2; do
    for how in "" "--as-in-paper" "--as-in-paper --smooth=false" "--as-in-paper --cost volume"; do
      # shellcheck disable=SC2086
      "$gaussmap" simplify "$work/all.gmap" -o "$work/simple.gmap" --force --budget 4 $how >/dev/null
      refined "$work/simple.gmap"
      compare "scale $scale, ${how:-default}" "$work/simple.gmap" "$work/refined.gmap" $scale
    done
  done
else
  echo "test/benchmark/merge.sh: expected merge, simplify or as-in-paper, found '$what'" >&2
  exit 2
fi
