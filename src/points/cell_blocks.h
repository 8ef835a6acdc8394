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

/// Of a byte: without an instruction of its own the compiler calls a function.
inline const std::array<std::uint8_t, 256> kBitCount = [] {
  std::array<std::uint8_t, 256> counts{};
  for (unsigned i = 1; i < 256; ++i) counts[i] = std::uint8_t(counts[i / 2] + i % 2);
  return counts;
}();

/// A cell of one level: its points, and its children among the cells of the next finer level. An octant's points are
/// borders[k] ... borders[k + 1] - 1; of a cell that is not split only the first and the last border count.
struct OctreeCell {
  std::array<std::uint32_t, 9> borders{};
  std::uint32_t first_child = 0;
  std::uint32_t children = 0;  // a bit an octant

  PointRange points() const { return {borders[0], borders[8]}; }
};

/// One of the 3 x 3 x 3 cells around an open one.
struct Near {
  std::uint32_t cell;   // of its level
  std::uint32_t place;  // of the 27, x fastest
};
inline constexpr std::uint32_t kMiddle = 13;

/// A cell with queries whose block of 3 x 3 x 3 cells has enough points, maybe enough for finer ones.
struct OpenCell {
  PointRange queries;
  std::uint32_t first_near = 0, near_count = 0;  // in the list of those that there are
};

/// The 3 x 3 x 3 cells around an open one have 6 x 6 x 6 octants. The block of 3 x 3 x 3 octants around octant k of the
/// cell in the middle lies in eight of the cells, the block of 5 x 5 x 5 in all. Bits 8 j + octant of a word stand for
/// the octants of eight cells: of the corners of the smaller block, or of cells 8 w ... 8 w + 7.
struct Blocks {
  static constexpr std::array<std::uint8_t, 8> kCorners = {0, 1, 3, 4, 9, 10, 12, 13};  // places from the lowest one on
  std::array<std::uint8_t, 8> lowest{};                 // of k: the place of the block's lowest cell
  std::array<std::uint64_t, 8> three{};                 // of k: the block's octants
  std::array<std::array<std::uint8_t, 64>, 8> place{};  // of k: where each is in the finer 3 x 3 x 3
  std::array<std::array<std::uint64_t, 4>, 8> five{};   // of k: what lies two off along one axis, one along others

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

/// The cells around an open one. Which octants have points is as good as random, and a wrongly guessed branch costs
/// more than ten sums: so octants are told by bits, and there is one loop over the bits of a block.
class Surroundings {
 public:
  void add(const OctreeCell& cell, std::uint32_t place) {
    children_[place] = std::uint8_t(cell.children);
    cells_[place] = &cell;
  }
  const OctreeCell& middle() const { return *cells_[kMiddle]; }
  /// Of the block around octant k, those that have points.
  std::uint64_t three(unsigned k) const {
    std::uint64_t octants = 0;
    for (std::size_t j = 0; j < 8; ++j)
      octants |= std::uint64_t{children_[kBlocks.lowest[k] + Blocks::kCorners[j]]} << 8 * j;
    return octants & kBlocks.three[k];
  }
  /// Their points, joined to the ranges; returns how many.
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
  /// The same of what the next larger block has besides.
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
  /// The finer cells of the block around octant k.
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
  std::array<std::uint8_t, 32> children_{};  // of each of the 27 cells a bit an octant
  std::array<const OctreeCell*, 32> cells_;
};

}  // namespace gaussmap::detail
