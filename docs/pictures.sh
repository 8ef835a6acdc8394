#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of the documentation again: docs/*.png, from a simulated street. Needs the viewer and ImageMagick
# (apt-get install imagemagick fonts-lato). Usage: docs/pictures.sh GAUSSMAP
set -euo pipefail
gaussmap=$(realpath "${1:?usage: docs/pictures.sh GAUSSMAP}")
docs=$(cd "$(dirname "$0")" && pwd)
command -v convert >/dev/null || { echo "docs/pictures.sh: apt-get install imagemagick fonts-lato" >&2; exit 1; }
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
ls -l "$docs"/*.png
