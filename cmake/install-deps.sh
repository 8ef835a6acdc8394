#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages that are needed to build and test gaussmap, as root or through sudo. Prints the packages
# that it installs, and does nothing if all are installed. Usage: cmake/install-deps.sh [--checks | --docs]
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache pkg-config
  libeigen3-dev libtbb-dev libnanoflann-dev libboost-dev   # core: algebra, threads, nearest neighbours, containers
  libsqlite3-dev libzstd-dev liblzf-dev zlib1g-dev         # files: maps, compressed PCD, laser logs
  liblz4-dev libbz2-dev libpugixml-dev                     # files: recordings of ROS, E57
  libpcl-dev                                               # PCL plug-ins
  libvtk9-dev libegl-dev libegl-mesa0 libx11-dev           # viewer; Mesa draws pictures without a display
  libcli11-dev nlohmann-json3-dev libflann-dev             # command line
  libgtest-dev liboctomap-dev pcl-tools                    # tests; programs that the benchmarks compare with
)
case "${1:-}" in
  "") ;;
  --checks)  # sanitizers, fuzzers, lint; the tests of man pages, completions and of the Python reader of maps
    packages+=(git clang libclang-rt-14-dev clang-format clang-tidy cppcheck
               mandoc zsh fish python3-numpy python3-zstandard)
    ;;
  --docs)  # only what docs/build.sh needs
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
