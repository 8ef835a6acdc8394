#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs, builds, runs tests. Usage: test/run.sh [--sanitize | --sanitize-library | --threads] [options of ctest]
#   (nothing)   all tests, optimised
#   --sanitize  all tests under address, leak and undefined-behaviour sanitizers (clang; without PCL and the viewer)
#   --sanitize-library  the same without the tests of the command line, in about two thirds of the time
#   --threads   the tests that use threads under the thread sanitizer
set -euo pipefail
cd "$(dirname "$0")/.."

preset=release select=() packages=() switches=()
case "${1:-}" in
  --sanitize | --sanitize-library)
    [[ $1 == --sanitize ]] && switches=(-DGAUSSMAP_BUILD_APPS=ON) || switches=(-DGAUSSMAP_BUILD_APPS=OFF)
    shift
    preset=sanitize packages=(--checks)
    ;;
  --threads)
    shift
    preset=threads select=(-R '[Tt]hread')
    export TSAN_OPTIONS="suppressions=$PWD/test/tsan.supp halt_on_error=1"
    ;;
  --*)
    sed -n '3,7p' "$0" >&2
    exit 2
    ;;
esac

./cmake/install-deps.sh "${packages[@]}"
launcher=$(command -v ccache || true)
cmake --preset "$preset" -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" "${switches[@]}" >/dev/null
cmake --build "build/$preset" -j 2
ctest --test-dir "build/$preset" -j 2 --timeout 600 --output-on-failure --progress "${select[@]}" "$@"
