#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs, builds, runs all tests. Usage: test/run.sh [--sanitize] (with: address and undefined-behaviour sanitizers)
set -euo pipefail
cd "$(dirname "$0")/.."

folder=build/release
options=(-DCMAKE_BUILD_TYPE=Release -DGAUSSMAP_BUILD_BENCHMARKS=ON)
case "${1:-}" in
  "") ;;
  --sanitize)
    folder=build/sanitize
    # No benchmarks: pcl::VoxelGridCovariance, half in PCL's library and half in our instrumented program, reports itself.
    options=(-DCMAKE_BUILD_TYPE=Debug -DGAUSSMAP_BUILD_BENCHMARKS=OFF "-DCMAKE_CXX_FLAGS=-O1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer")
    ;;
  *)
    echo "usage: test/run.sh [--sanitize]" >&2
    exit 2
    ;;
esac

./cmake/install-deps.sh
launcher=$(command -v ccache || true)
cmake -S . -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" "${options[@]}" >/dev/null
cmake --build "$folder" -j 2
ctest --test-dir "$folder" -j 2 --output-on-failure --progress
