#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the fuzzers with clang and runs each for SECONDS, with the address and undefined-behaviour sanitizers. The
# seeds are in test/fuzz/corpus; new inputs go to build/sanitize/corpus, findings to build/sanitize/findings.
# Usage: test/fuzz/run.sh [SECONDS [TARGET...]] (default: 30 seconds each, all targets)
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-30}
./cmake/install-deps.sh --checks
build=build/sanitize
launcher=$(command -v ccache || true)
cmake --preset sanitize -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" >/dev/null
targets=("${@:2}")
if ((${#targets[@]} == 0)); then
  for seeds in test/fuzz/corpus/*/; do targets+=("$(basename "$seeds")"); done
fi
cmake --build "$build" -j 2 --target "${targets[@]/#/fuzz_}"
mkdir -p "$build/findings"
fuzz() {  # target
  mkdir -p "$build/corpus/$1"
  "$build/test/fuzz/fuzz_$1" -seed=1 -max_total_time="$seconds" -timeout=60 -rss_limit_mb=2048 -max_len=65536 \
    -artifact_prefix="$build/findings/$1-" "$build/corpus/$1" "test/fuzz/corpus/$1" >"$build/$1.log" 2>&1 ||
    { tail -40 "$build/$1.log" >&2; echo "fuzz_$1: a finding, see $build/findings" >&2; return 1; }
  echo "fuzz_$1: $(grep -E '^Done|DONE' "$build/$1.log" | tail -1)"
}
export -f fuzz
export build seconds
printf '%s\n' "${targets[@]}" | xargs -P 2 -I{} bash -c 'fuzz {}'
