// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "points/morton_points.h"
#include "points/plane_batch.h"

namespace gaussmap::detail {

/// Number of set bits per byte value. Without a POPCNT instruction, __builtin_popcount() would call a function.
inline const std::array<std::uint8_t, 256> kBitCount = [] {
  std::array<std::uint8_t, 256> counts{};
  for (unsigned i = 1; i < 256; ++i) counts[i] = std::uint8_t(counts[i / 2] + i % 2);
  return counts;
}();

/// A cell of one octree level, with its points and its children in the next finer level. The points of octant k are
/// borders[k] ... borders[k + 1] - 1. If the cell is not split, only the first and the last border are valid.
struct OctreeCell {
  std::array<std::uint32_t, 9> borders{};
  std::uint32_t first_child = 0;
  std::uint32_t children = 0;  // one bit per octant that has points

  PointRange points() const { return {borders[0], borders[8]}; }
};

/// One of the 3 x 3 x 3 cells around an open cell, or the open cell itself.
struct Near {
  std::uint32_t cell;   // index in its level
  std::uint32_t place;  // position among the 27 cells, x fastest
};
inline constexpr std::uint32_t kMiddle = 13;

/// A cell with queries whose block of 3 x 3 x 3 cells has enough points. A finer block may have enough points too.
struct OpenCell {
  PointRange queries;
  std::uint32_t first_near = 0, near_count = 0;  // range in the list of its Near cells that exist
};

/// Tables of the octants that belong to a block. The 3 x 3 x 3 cells around an open cell have 6 x 6 x 6 octants. The
/// block of 3 x 3 x 3 octants around octant k of the middle cell lies in eight of the cells, the block of 5 x 5 x 5 in
/// all 27. Bit 8 j + octant of a word represents an octant of the j-th of eight cells. These are either the eight cells
/// of the smaller block, or the cells 8 w ... 8 w + 7 of the 27.
struct Blocks {
  static constexpr std::array<std::uint8_t, 8> kCorners = {0, 1, 3, 4, 9, 10, 12, 13};  // relative to `lowest`
  std::array<std::uint8_t, 8> lowest{};                 // per k: place of the block's lowest cell
  std::array<std::uint64_t, 8> three{};                 // per k: octants of the block of 3 x 3 x 3
  std::array<std::array<std::uint8_t, 64>, 8> place{};  // per k: place of each octant among the finer 27
  std::array<std::array<std::uint64_t, 4>, 8> five{};   // per k: octants two off along one axis only

  Blocks() {
    for (unsigned k = 0; k < 8; ++k) {
      lowest[k] = std::uint8_t((k & 1) + 3 * (k >> 1 & 1) + 9 * (k >> 2));
      for (int z = 0; z < 6; ++z)
        for (int y = 0; y < 6; ++y)
          for (int x = 0; x < 6; ++x) {
            const int dx = x - 2 - int(k & 1), dy = y - 2 - int(k >> 1 & 1), dz = z - 2 - int(k >> 2);
            const int most = std::max({std::abs(dx), std::abs(dy), std::abs(dz)});
            const int two = (std::abs(dx) == 2) + (std::abs(dy) == 2) + (std::abs(dz) == 2);
            const auto cell = std::size_t(x / 2) + 3 * std::size_t(y / 2) + 9 * std::size_t(z / 2);
            const auto octant = std::size_t((x & 1) | (y & 1) << 1 | (z & 1) << 2);
            if (most == 2 && two == 1) five[k][cell / 8] |= std::uint64_t{1} << (8 * (cell % 8) + octant);
            if (most > 1) continue;
            const auto corner = std::find(kCorners.begin(), kCorners.end(), cell - lowest[k]) - kCorners.begin();
            const std::size_t bit = 8 * std::size_t(corner) + octant;
            three[k] |= std::uint64_t{1} << bit;
            place[k][bit] = std::uint8_t(dx + 1 + 3 * (dy + 1) + 9 * (dz + 1));
          }
    }
  }
};
inline const Blocks kBlocks;

/// The cells around an open cell. Which octants have points is almost random, and a mispredicted branch costs more than
/// ten sums. Therefore octants are represented by bits, and one loop runs over the bits of a block.
class Surroundings {
 public:
  void add(const OctreeCell& cell, std::uint32_t place) {
    children_[place] = std::uint8_t(cell.children);
    cells_[place] = &cell;
  }
  const OctreeCell& middle() const { return *cells_[kMiddle]; }
  /// Returns the octants with points in the block of 3 x 3 x 3 around octant k.
  std::uint64_t three(unsigned k) const {
    std::uint64_t octants = 0;
    for (std::size_t j = 0; j < 8; ++j)
      octants |= std::uint64_t{children_[kBlocks.lowest[k] + Blocks::kCorners[j]]} << 8 * j;
    return octants & kBlocks.three[k];
  }
  /// Adds the points of these octants to the ranges. Returns the number of points.
  std::uint32_t gatherThree(unsigned k, std::uint64_t octants, PlaneRanges& ranges) const {
    std::uint32_t count = 0;
    PlaneRanges::Adder adder(ranges);
    for (; octants; octants &= octants - 1) {
      const auto bit = std::size_t(__builtin_ctzll(octants));
      const OctreeCell& cell = *cells_[kBlocks.lowest[k] + Blocks::kCorners[bit / 8]];
      count += adder.add(cell.borders[bit % 8], cell.borders[bit % 8 + 1]);
    }
    return count;
  }
  /// Like gatherThree(), for the octants that the block of 5 x 5 x 5 has in addition.
  std::uint32_t gatherFive(unsigned k, PlaneRanges& ranges) const {
    std::uint32_t count = 0;
    PlaneRanges::Adder adder(ranges);
    for (std::size_t word = 0; word < 4; ++word) {
      std::uint64_t octants = 0;
      for (std::size_t j = 0; j < 8; ++j) octants |= std::uint64_t{children_[8 * word + j]} << 8 * j;
      for (octants &= kBlocks.five[k][word]; octants; octants &= octants - 1) {
        const auto bit = std::size_t(__builtin_ctzll(octants));
        const OctreeCell& cell = *cells_[8 * word + bit / 8];
        count += adder.add(cell.borders[bit % 8], cell.borders[bit % 8 + 1]);
      }
    }
    return count;
  }
  /// Appends the finer cells of the block around octant k to `near`.
  void append(unsigned k, std::uint64_t octants, std::vector<Near>& near) const {
    std::array<Near, 27> finer;
    std::size_t size = 0;
    for (; octants; octants &= octants - 1) {
      const auto bit = std::size_t(__builtin_ctzll(octants));
      const OctreeCell& cell = *cells_[kBlocks.lowest[k] + Blocks::kCorners[bit / 8]];
      finer[size++] = {cell.first_child + kBitCount[cell.children & ((1u << bit % 8) - 1u)], kBlocks.place[k][bit]};
    }
    near.insert(near.end(), finer.begin(), finer.begin() + std::ptrdiff_t(size));
  }

 private:
  std::array<std::uint8_t, 32> children_{};  // OctreeCell::children of the 27 cells
  std::array<const OctreeCell*, 32> cells_;
};

}  // namespace gaussmap::detail
