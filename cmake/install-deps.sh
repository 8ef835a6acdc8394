#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages that are needed to build and test gaussmap, as root or through sudo. Prints the packages
# that it installs, and does nothing if all are installed. Usage: cmake/install-deps.sh [--checks]
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache pkg-config
  libeigen3-dev libtbb-dev libnanoflann-dev libboost-dev   # core: algebra, threads, nearest neighbours, containers
  libsqlite3-dev libzstd-dev liblzf-dev zlib1g-dev         # core: map files, compressed PCD, laser logs
  libpcl-dev                                               # PCL plug-ins
  libvtk9-dev libegl-dev libegl-mesa0 libx11-dev           # viewer; Mesa draws pictures without a display
  libcli11-dev nlohmann-json3-dev                          # command line
  libgtest-dev liboctomap-dev pcl-tools                    # tests; programs that the benchmarks compare with
)
case "${1:-}" in
  "") ;;
  --checks) packages+=(git clang libclang-rt-14-dev clang-format clang-tidy cppcheck  # sanitizers, fuzzers, lint
                        mandoc zsh fish) ;;  # man pages and completions
  *) echo "usage: cmake/install-deps.sh [--checks]" >&2; exit 2 ;;
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
