#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of the documentation again: docs/*.png, from a simulated street and a simulated plan. Needs the
# viewer, ImageMagick and a browser (apt-get install imagemagick fonts-lato chromium). Usage: docs/pictures.sh GAUSSMAP
set -euo pipefail
gaussmap=$(realpath "${1:?usage: docs/pictures.sh GAUSSMAP}")
docs=$(cd "$(dirname "$0")" && pwd)
for program in convert chromium; do
  command -v $program >/dev/null ||
    { echo "docs/pictures.sh: apt-get install imagemagick fonts-lato chromium" >&2; exit 1; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$gaussmap" simulate street -o world
"$gaussmap" pcd2map world/scans -o one.gmap --budget 1
"$gaussmap" refine one.gmap -o four.gmap --budget 4

# The 10 m cells before and after refinement, seen along the street.
panel() {  # map, caption
  "$gaussmap" view "$1.gmap" --scale 2 --color height --sigma 1.8 --view=-0.92,-0.39,0.36 --zoom 2.2 --at 2 -11 2 \
    --size 600x500 --png "$1.png"
  convert "$1.png" -background white -gravity north -splice 0x40 -font /usr/share/fonts/truetype/lato/Lato-Bold.ttf \
    -pointsize 22 -annotate +0+9 "$2" "$1.png"
}
panel one "One Gaussian per 10 m cell: 101 Gaussians"
panel four "After refinement, four per cell: 404 Gaussians"
convert one.png four.png +append -define png:compression-level=9 "$docs/street.png"

# The three scales.
for scale in 0 1 2; do
  "$gaussmap" view four.gmap --scale $scale --color normal --view=-0.8,-0.75,0.55 --zoom 3 --size 600x400 \
    --png view.png --force
  convert view.png +dither -colors 64 -define png:compression-level=9 "$docs/street-$scale.png"
done

# Yguel et al. 2009, Fig. 1: the scene, the 1 m cells, and the 10 m cells before and after refinement.
figure() {  # name of the picture, caption, file, options of view
  local name=$1 caption=$2 file=$3
  shift 3
  "$gaussmap" view "$file" "$@" --view=-0.92,-0.39,0.36 --at 2 -11 2 --span 26 --size 700x490 --png "$name.png"
  convert "$name.png" -background white -gravity north -splice 0x40 -font /usr/share/fonts/truetype/lato/Lato-Bold.ttf \
    -pointsize 22 -annotate +0+9 "$caption" "$name.png"
}
figure scene "The scene" world/truth.ply
figure fine "Fine scale: 1 m cells, 33,932 Gaussians" four.gmap --scale 1
figure coarse "Coarse scale: 10 m cells, 101 Gaussians" one.gmap --scale 2 --sigma 1.8
figure refined "Coarse scale after refinement: 404 Gaussians" four.gmap --scale 2 --sigma 1.8
convert scene.png fine.png +append top.png
convert coarse.png refined.png +append bottom.png
convert top.png bottom.png -append +dither -colors 220 -define png:compression-level=9 "$docs/figure-1.png"

# Fig. 5 and Fig. 6: the errors of the 10 m cells, and the hierarchy of the clusters.
drawn() {  # NAME: NAME.svg -> NAME.png
  size=$(sed -n "1s/.*width='\([0-9]*\)[^']*' height='\([0-9]*\).*/\1,\2/p" "$1.svg")
  chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size="$size" --screenshot="$1.png" \
    "file://$PWD/$1.svg"
}
"$gaussmap" draw four.gmap -o contribution.svg --color contribution
"$gaussmap" draw four.gmap -o cells.svg --color cell-error
drawn contribution
drawn cells
convert contribution.png cells.png -append +dither -colors 64 -define png:compression-level=9 "$docs/figure-5.png"
"$gaussmap" view four.gmap --hierarchy --size 1000x700 --png hierarchy.png
convert hierarchy.png +dither -colors 220 -define png:compression-level=9 "$docs/figure-6.png"

# A planar map: the coarsest scale over the finest one, as in planar.md.
"$gaussmap" simulate plan -o plan --noise 0.02
"$gaussmap" pcd2map --planar plan/scans -o plan.gmap --resolution 0.05
"$gaussmap" draw plan.gmap -o plan.svg --overlay
drawn plan
convert plan.png +dither -colors 64 -define png:compression-level=9 "$docs/planar.png"
ls -l "$docs"/*.png
