#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What tools see without running anything: layers, plain words, public headers, clang-format, cppcheck, clang-tidy.
# Usage: test/lint.sh [--quick | --changed [REV] | FILE...]
#   --quick          without clang-tidy, which takes as long as a build
#   --changed [REV]  clang-tidy checks the sources that differ from REV only (default: the last commit)
#   FILE...          clang-tidy checks these sources only; without, all of the library and the command line
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in
  --quick | --changed | [!-]* | "") ;;
  *) sed -n '4,7p' "$0" >&2; exit 2 ;;
esac
./cmake/install-deps.sh --checks

python3 test/layers.py

# Habits that make a text hard to read. CONTRIBUTING.md says what to write instead.
habits='\banew\b|\bthat (is|are) none\b|\bstands? for\b|\bwhoever\b|\bhoped for\b|never shows? in|to the last bit|\*\*wanted|\(wanted [0-9]'
if git grep -nIiE "$habits" -- ':!test/lint.sh' ':!test/data' ':!test/fuzz/corpus'; then
  echo "lint: write these sentences in plain English" >&2
  exit 1
fi
echo "words: no sentence of the worst kinds"

# Every public header compiles alone.
read -ra system < <(pkg-config --cflags-only-I eigen3 pcl_common | sed 's/-I/-isystem /g')
(cd include && find gaussmap -name '*.h' | sort) | xargs -P 2 -I{} \
  sh -c 'echo "#include \"$0\"" | g++ -std=c++17 -fsyntax-only -I include "$@" -x c++ - ||
         { echo "include/$0: does not compile alone" >&2; exit 255; }' {} "${system[@]}"
echo "public headers: each compiles alone"

mapfile -t all < <(git ls-files '*.cpp' '*.h' '*.hpp')
clang-format --dry-run -Werror "${all[@]}"
echo "clang-format: ${#all[@]} files, formatted"

cppcheck --std=c++17 --language=c++ --enable=warning,performance,portability --inline-suppr \
  --suppressions-list=.cppcheck --error-exitcode=1 -I include -I src -I apps --quiet -j 2 src apps include
echo "cppcheck: clean"
[[ ${1:-} != --quick ]] || exit 0

selection=('src/*.cpp' 'apps/*.cpp' ':!src/pcl' ':!src/viewer' ':!apps/viewer')
case "${1:-}" in
  --changed)
    base=${2:-HEAD~1}
    mapfile -t sources < <(git diff --name-only --diff-filter=d "$base" -- "${selection[@]}")
    ;;
  "") mapfile -t sources < <(git ls-files "${selection[@]}") ;;
  *) sources=("$@") ;;
esac
if ((${#sources[@]} > 0)); then
  folder=build/lint
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DGAUSSMAP_FAST_BUILD=OFF -DGAUSSMAP_BUILD_PCL=OFF -DGAUSSMAP_BUILD_VIEWER=OFF \
    -DGAUSSMAP_BUILD_TESTS=OFF >/dev/null
  printf '%s\0' "${sources[@]}" | xargs -0 -P 2 -n 4 clang-tidy -p "$folder" --quiet --warnings-as-errors='*' 2>/dev/null
fi
echo "clang-tidy: ${#sources[@]} sources, clean"
