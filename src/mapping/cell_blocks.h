// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "mapping/morton_points.h"

namespace gaussmap {

inline constexpr std::uint32_t kNoCell = 0xFFFFFFFFu;

/// Of a byte: without an instruction of its own the compiler calls a function.
inline const std::array<std::uint8_t, 256> kBitCount = [] {
  std::array<std::uint8_t, 256> counts{};
  for (unsigned i = 1; i < 256; ++i) counts[i] = std::uint8_t(counts[i / 2] + i % 2);
  return counts;
}();

/// Sixteen-bit numbers, one an octant, four a word.
struct Lanes {
  static constexpr std::uint32_t kMost = 2000;  // points an octant counts for: all that is added up fits
  std::uint64_t low = 0, high = 0;

  void add(unsigned octant, std::uint64_t value) { (octant < 4 ? low : high) += value << 16 * (octant & 3); }
  void addMasked(const Lanes& other, const Lanes& mask) {
    low += other.low & mask.low;
    high += other.high & mask.high;
  }
  std::uint32_t total() const {
    constexpr std::uint64_t kOnes = 0x0001000100010001ull;
    return std::uint32_t(low * kOnes >> 48) + std::uint32_t(high * kOnes >> 48);
  }
};

/// A cell of one level: its points, and its children among the cells of the next finer level.
struct Cell {
  Range points;
  std::uint32_t first_child = 0;
  std::uint8_t children = 0;            // a bit an octant
  Lanes counts;                         // of the points of the octants, at most Lanes::kMost each
  std::array<std::uint32_t, 7> ends{};  // where the points of octants 0 ... 6 end

  Range octant(unsigned k) const { return {k == 0 ? points.first : ends[k - 1], k == 7 ? points.last : ends[k]}; }
  std::uint32_t child(unsigned k) const { return first_child + kBitCount[children & ((1u << k) - 1u)]; }
};

/// A cell with queries whose block of 3 x 3 x 3 cells has enough points, maybe enough for finer ones.
struct Open {
  Range queries;
  std::array<std::uint32_t, 27> near;  // cells of its level, x fastest; kNoCell where there is none
};

/// Octants of one of the 3 x 3 x 3 cells.
struct Share {
  std::uint32_t cell = 0;     // of the 27
  std::uint32_t octants = 0;  // a bit an octant
  Lanes lanes;                // the same, all bits an octant

  void take(unsigned octant) {
    octants |= 1u << octant;
    lanes.add(octant, 0xFFFF);
  }
};

/// Octants of the 3 x 3 x 3 cells are 6 x 6 x 6 finer cells: which of them make the blocks around an octant of the cell
/// in the middle.
struct Blocks {
  std::array<std::vector<Share>, 8> three;  // 3 x 3 x 3
  std::array<std::vector<Share>, 8> five;   // what lies two off along one axis, at most one along the others
  std::array<std::array<std::pair<std::uint8_t, std::uint8_t>, 27>, 8>
      near;  // cell of the 27 and its octant, of `three`

  Blocks() {
    for (int k = 0; k < 8; ++k)
      for (int z = 0; z < 6; ++z)
        for (int y = 0; y < 6; ++y)
          for (int x = 0; x < 6; ++x) {
            const int dx = x - 2 - (k & 1), dy = y - 2 - (k >> 1 & 1), dz = z - 2 - (k >> 2);
            const auto cell = std::uint32_t(x / 2 + 3 * (y / 2) + 9 * (z / 2));
            const auto octant = unsigned((x & 1) | (y & 1) << 1 | (z & 1) << 2);
            const int two = (std::abs(dx) == 2) + (std::abs(dy) == 2) + (std::abs(dz) == 2);
            if (std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) > 2 || two > 1) continue;
            shareOf((two ? five : three)[std::size_t(k)], cell).take(octant);
            if (!two)
              near[std::size_t(k)][std::size_t(dx + 1 + 3 * (dy + 1) + 9 * (dz + 1))] = {std::uint8_t(cell),
                                                                                         std::uint8_t(octant)};
          }
  }
  static Share& shareOf(std::vector<Share>& shares, std::uint32_t cell) {
    for (Share& share : shares)
      if (share.cell == cell) return share;
    shares.push_back({cell, 0, {}});
    return shares.back();
  }
};
inline const Blocks kBlocks;

}  // namespace gaussmap
