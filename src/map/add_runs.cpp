// SPDX-License-Identifier: BSD-3-Clause
#include "map/add_runs.h"

#include <type_traits>

#if defined(__x86_64__) && defined(__GNUC__)
#define GAUSSMAP_HAS_AVX2_PATH
#include <immintrin.h>
#endif

namespace gaussmap::detail {

#ifdef GAUSSMAP_HAS_AVX2_PATH
namespace {

// The sums of a cell are ten 64-bit integers in a row: count x y z | xx xy xz yy | yz zz.
static_assert(std::is_standard_layout_v<CellMoments<3>> && sizeof(CellMoments<3>) == 10 * sizeof(std::int64_t));

__attribute__((target("avx2"))) void addRunsAvx2(const Runs<3>& runs) {
  const __m128i one = _mm_set1_epi32(1);
  for (std::size_t run = 0; run < runs.count; ++run) {
    auto* sums = reinterpret_cast<__m256i*>(runs.cells[run]);
    auto* last_sums = reinterpret_cast<__m128i*>(sums + 2);
    __m256i first = _mm256_loadu_si256(sums), second = _mm256_loadu_si256(sums + 1);
    __m128i third = _mm_loadu_si128(last_sums);
    for (std::size_t i = runs.starts[run]; i < runs.starts[run + 1]; ++i) {
      const __m128i xy = _mm_unpacklo_epi32(_mm_cvtsi32_si128(runs.offset[0][i]), _mm_cvtsi32_si128(runs.offset[1][i]));
      const __m128i z1 = _mm_unpacklo_epi32(_mm_cvtsi32_si128(runs.offset[2][i]), one);
      const __m256i xyz1 = _mm256_cvtepi32_epi64(_mm_unpacklo_epi64(xy, z1));
      const __m256i xxxy = _mm256_permute4x64_epi64(xyz1, _MM_SHUFFLE(1, 0, 0, 0));
      const __m256i xyzy = _mm256_permute4x64_epi64(xyz1, _MM_SHUFFLE(1, 2, 1, 0));
      const __m128i yz = _mm256_castsi256_si128(_mm256_permute4x64_epi64(xyz1, _MM_SHUFFLE(0, 0, 2, 1)));
      first = _mm256_add_epi64(first, _mm256_permute4x64_epi64(xyz1, _MM_SHUFFLE(2, 1, 0, 3)));
      second = _mm256_add_epi64(second, _mm256_mul_epi32(xxxy, xyzy));
      third = _mm_add_epi64(third, _mm_mul_epi32(yz, _mm_unpackhi_epi64(yz, yz)));
    }
    _mm256_storeu_si256(sums, first);
    _mm256_storeu_si256(sums + 1, second);
    _mm_storeu_si128(last_sums, third);
  }
}

}  // namespace
#endif

void addRuns(const Runs<2>& runs) {
  addRunsPlainly(runs);
}

void addRuns(const Runs<3>& runs) {
#ifdef GAUSSMAP_HAS_AVX2_PATH
  static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  if (has_avx2) return addRunsAvx2(runs);
#endif
  addRunsPlainly(runs);
}

}  // namespace gaussmap::detail
