// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/huge_pages.h"

namespace gaussmap::detail {

/// Bits per axis of a Morton code.
inline constexpr int kMortonBits = 21;

/// Spreads the low 21 bits of a number to every third bit.
inline std::uint64_t spreadBits(std::uint64_t bits) {
  bits &= 0x1FFFFF;
  bits = (bits | bits << 32) & 0x1F00000000FFFFull;
  bits = (bits | bits << 16) & 0x1F0000FF0000FFull;
  bits = (bits | bits << 8) & 0x100F00F00F00F00Full;
  bits = (bits | bits << 4) & 0x10C30C30C30C30C3ull;
  return (bits | bits << 2) & 0x1249249249249249ull;
}

/// Returns the Morton code: one octant digit (3 bits) per level, coarsest first, with x in the lowest bit. Each
/// coordinate is below 2^21.
inline std::uint64_t mortonCode(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spreadBits(x) | spreadBits(y) << 1 | spreadBits(z) << 2;
}

struct MortonItem {
  std::uint64_t code;
  std::uint32_t index;
};

using MortonItems = std::vector<MortonItem, PagesAllocator<MortonItem>>;

/// Sorts items by code; the order of equal codes is kept. `spare` is working memory and grows to `count`.
inline void sortByCode(MortonItem* items, std::size_t count, MortonItems& spare) {
  constexpr std::size_t kDigits = 2048;  // 11 bits of the code per pass
  constexpr std::size_t kFewItems = 2000;
  if (count < kFewItems) {
    std::stable_sort(items, items + count, [](const MortonItem& a, const MortonItem& b) { return a.code < b.code; });
    return;
  }
  spare.resize(std::max(spare.size(), count));
  MortonItem *from = items, *to = spare.data();
  for (int shift = 0; shift < 66; shift += 11) {  // an even number of passes: the result is in `items`
    std::array<std::size_t, kDigits> place{};
    for (std::size_t i = 0; i < count; ++i) ++place[from[i].code >> shift & (kDigits - 1)];
    std::size_t sum = 0;
    for (std::size_t& entry : place) {
      const std::size_t here = entry;
      entry = sum;
      sum += here;
    }
    for (std::size_t i = 0; i < count; ++i) to[place[from[i].code >> shift & (kDigits - 1)]++] = from[i];
    std::swap(from, to);
  }
}

}  // namespace gaussmap::detail
