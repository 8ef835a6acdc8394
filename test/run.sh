#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs, builds, runs all tests. Usage: test/run.sh [--sanitize] (with: address and undefined-behaviour sanitizers)
set -euo pipefail
cd "$(dirname "$0")/.."

folder=build/release
options=(-DCMAKE_BUILD_TYPE=Release)
case "${1:-}" in
  "") ;;
  --sanitize)
    folder=build/sanitize
    options=(-DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS=-O1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer")
    ;;
  *)
    echo "usage: test/run.sh [--sanitize]" >&2
    exit 2
    ;;
esac

./cmake/install-deps.sh
launcher=$(command -v ccache || true)
cmake -S . -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" -DGAUSSMAP_BUILD_BENCHMARKS=ON "${options[@]}" >/dev/null
cmake --build "$folder" -j 2
ctest --test-dir "$folder" -j 2 --output-on-failure --progress
