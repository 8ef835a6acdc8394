#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the documentation as HTML: Doxygen reads the public headers, breathe and Sphinx make the pages. A warning is an
# error. Installs the Debian packages that are missing. Usage: docs/build.sh [FOLDER] (default: build/docs)
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-build/docs}
./cmake/install-deps.sh --docs

mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
parts=$(mktemp -d)  # what the pages are made from
trap 'rm -rf "$parts"' EXIT
(cat docs/Doxyfile && echo "OUTPUT_DIRECTORY = $parts") | doxygen -
/usr/bin/python3 docs/stage.py "$parts/pages" "$parts/xml"
GAUSSMAP_TOP=$PWD GAUSSMAP_DOXYGEN_XML=$parts/xml /usr/bin/python3 -m sphinx -W -n --keep-going -q -b html -d "$parts/doctrees" \
  "$parts/pages" "$folder"
echo "written: $folder/index.html"
