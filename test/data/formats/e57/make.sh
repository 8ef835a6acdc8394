#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Makes the files of this folder again: make.sh LIBE57FORMAT WEB_E57
#   LIBE57FORMAT  a clone of https://github.com/asmaloney/libE57Format, commit 21c2943 (version 3.4.0), built in its folder build
#                 with cmake -DCMAKE_BUILD_TYPE=Release -DE57_BUILD_TEST=OFF -DE57_BUILD_SHARED=OFF (needs libxerces-c-dev)
#   WEB_E57       a folder in which `npm install web-e57@1.2.0` has run (node 20)
# NAME.e57  written by libE57Format
# NAME.txt  all numbers of NAME.e57, read by libE57Format
# NAME.xyz  valid points in the frame of the map and colours, read by web-e57 (the Rust crate e57); it refuses strings.e57
set -eu
here=$(cd "$(dirname "$0")" && pwd)
lib=$1
web=$2
work=$(mktemp -d)
g++ -std=c++17 -O2 -I "$lib/include" -I "$lib/build" "$here/make.cpp" "$lib/build/libE57Format.a" -lxerces-c -lpthread -o "$work/make"
"$work/make" write "$here"
for name in scans widths strings; do
  "$work/make" text "$here/$name.e57" > "$here/$name.txt"
done
cat > "$web/convert.mjs" <<'END'
import { convertE57 } from 'web-e57';
import fs from 'fs';
process.stdout.write(convertE57(new Uint8Array(fs.readFileSync(process.argv[2])), 'XYZ'));
END
for name in scans widths; do
  node --experimental-wasm-modules "$web/convert.mjs" "$here/$name.e57" > "$here/$name.xyz"
done
rm -r "$work"
