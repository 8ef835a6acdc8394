#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages that gaussmap is built and tested with. Works as root or through sudo,
# says what it does, and does nothing when all are there. Usage: cmake/install-deps.sh [--checks | --docs]
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache pkg-config
  libeigen3-dev libtbb-dev libnanoflann-dev libboost-dev   # core: algebra, threads, nearest neighbours, containers
  libsqlite3-dev libzstd-dev liblzf-dev zlib1g-dev         # core: map files, compressed PCD, laser logs
  libpcl-dev                                               # the PCL edge
  libvtk9-dev libegl-dev libegl-mesa0 libx11-dev           # the viewer; Mesa draws pictures without a display
  libcli11-dev nlohmann-json3-dev                          # the command line
  libgtest-dev liboctomap-dev pcl-tools                    # tests; peers of the benchmarks
)
case "${1:-}" in
  "") ;;
  --checks)  # sanitizers, fuzzers, lint, the Python reader of maps
    packages+=(git clang libclang-rt-14-dev clang-format clang-tidy cppcheck python3-numpy python3-zstandard)
    ;;
  --docs)  # the site: not what gaussmap is built with
    packages=(doxygen python3-sphinx python3-breathe python3-myst-parser python3-sphinx-copybutton python3-sphinx-rtd-theme)
    ;;
  *) echo "usage: cmake/install-deps.sh [--checks | --docs]" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null || true)
  [[ $status == ii* ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "gaussmap: all ${#packages[@]} Debian packages are installed"
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || { echo "gaussmap: run as root, or install sudo; missing: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "gaussmap: installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
echo "gaussmap: done"
