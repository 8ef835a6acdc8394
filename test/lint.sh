#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What tools can see without running anything: clang-format, cppcheck, clang-tidy.
# Usage: test/lint.sh [--quick | FILE...]
#   --quick   without clang-tidy, which takes as long as a build
#   FILE...   clang-tidy looks at these sources only; without, at all of the library and the command line
set -euo pipefail
cd "$(dirname "$0")/.."
[[ ${1:-} != -* || ${1:-} == --quick ]] || { echo "usage: test/lint.sh [--quick | FILE...]" >&2; exit 2; }
./cmake/install-deps.sh --checks

mapfile -t all < <(git ls-files '*.cpp' '*.h' '*.hpp')
clang-format --dry-run -Werror "${all[@]}"
echo "clang-format: ${#all[@]} files as they should be"

cppcheck --std=c++17 --language=c++ --enable=warning,performance,portability --inline-suppr \
  --suppressions-list=.cppcheck --error-exitcode=1 -I include -I src -I apps --quiet -j 2 src apps include
echo "cppcheck: clean"
[[ ${1:-} != --quick ]] || exit 0

folder=build/lint
launcher=$(command -v ccache || true)
cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang \
  -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DGAUSSMAP_BUILD_PCL=OFF \
  -DGAUSSMAP_BUILD_VIEWER=OFF -DGAUSSMAP_BUILD_TESTS=OFF >/dev/null
sources=("$@")
((${#sources[@]} > 0)) || mapfile -t sources < <(git ls-files 'src/*.cpp' 'apps/*.cpp' ':!src/pcl' ':!src/viewer' ':!apps/viewer')
printf '%s\0' "${sources[@]}" | xargs -0 -P 2 -n 4 clang-tidy -p "$folder" --quiet --warnings-as-errors='*' 2>/dev/null
echo "clang-tidy: ${#sources[@]} sources, clean"
