// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

// Contexts that LAZ derives from the number of a return and the number of returns of its pulse. They also give a
// context to impossible pairs, for example return 3 of 2. All tables are symmetric.
namespace gaussmap::detail {

template <std::size_t N>
using ReturnTable = std::array<std::array<std::uint8_t, N>, N>;

template <std::size_t N, typename Context>
constexpr ReturnTable<N> returnTable(Context context) {
  ReturnTable<N> table{};
  for (unsigned a = 0; a < N; ++a)
    for (unsigned b = 0; b < N; ++b) table[a][b] = static_cast<std::uint8_t>(context(std::min(a, b), std::max(a, b)));
  return table;
}

/// Formats 0 to 5: 16 contexts, one for each pair of up to four returns.
inline constexpr ReturnTable<8> kReturnContext = returnTable<8>([](unsigned low, unsigned high) {
  if (low == 0) return 15 - high;
  if (high == 7) return 8 + low;
  return std::min(high * (high - 1) / 2, 10u) + low - 1;
});

/// Formats 0 to 5: 8 contexts.
inline constexpr ReturnTable<8> kReturnLevel = returnTable<8>([](unsigned low, unsigned high) { return high - low; });

/// Formats 6 to 10: 6 contexts.
inline constexpr ReturnTable<16> kReturnContext14 = returnTable<16>([](unsigned low, unsigned high) {
  if (low == 0) return high < 6 ? high : high == 6 ? 3u : high < 9 ? 4u : 5u;
  if (high < 3) return high == 1 ? 0u : low;
  if (low == 1) return 3u;
  if (low == 2) return high <= 10 ? 4u : 3u;
  return low == high || (low >= 11 && high == low + 1) ? 5u : 4u;
});

/// Formats 6 to 10: 8 contexts.
inline constexpr ReturnTable<16> kReturnLevel14 =
    returnTable<16>([](unsigned low, unsigned high) { return std::min(high - low, 7u); });

}  // namespace gaussmap::detail
