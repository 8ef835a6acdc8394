// SPDX-License-Identifier: BSD-3-Clause
// 2^33 - 1 points a cell and not one more: sums are never wrapped.
#include <gtest/gtest.h>

#include <stdexcept>

#include "gaussmap/map/moment_grid.h"

namespace gaussmap {
namespace {

constexpr std::int64_t kMax = CellMoments<3>::kMaxPoints;

/// So many points at the corner of a cell, where products are largest.
CellMoments<3> corner(std::int64_t count) {
  constexpr std::int64_t kOffset = -32768;
  CellMoments<3> moments;
  moments.count = count;
  moments.sum.fill(kOffset * count);
  moments.product.fill(kOffset * kOffset * count);
  return moments;
}

/// Points of two cells, in turn as long as there are some of both.
PointBlock<3> block(std::size_t first_cell, std::size_t second_cell) {
  PointBlock<3> block;
  for (std::size_t i = 0; first_cell + second_cell > 0; ++i) {
    const bool is_first = second_cell == 0 || (first_cell > 0 && i % 2 == 0);
    --(is_first ? first_cell : second_cell);
    for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][block.size] = is_first ? 0.5 : 1.5;
    ++block.size;
  }
  return block;
}

TEST(CountLimit, OfMomentsIsThrownAndLeavesTheSums) {
  CellMoments<3> full = corner(kMax - 1);
  full.add({-32768, -32768, -32768});
  EXPECT_EQ(full, corner(kMax));
  EXPECT_GT(full.product[0], 0);
  EXPECT_THROW(full.add({0, 0, 0}), std::length_error);
  EXPECT_THROW(full += corner(1), std::length_error);
  EXPECT_THROW(full += corner(kMax), std::length_error);
  EXPECT_EQ(full, corner(kMax));
  full -= corner(5);
  full += corner(5);
  EXPECT_EQ(full, corner(kMax));
}

TEST(CountLimit, OfAGridIsThrownBeforeABlockIsCounted) {
  MomentGrid<3> grid(1.0);
  grid.add({0, 0, 0}, corner(kMax - 10));
  EXPECT_THROW(grid.add(block(11, 20)), std::length_error);
  EXPECT_EQ(grid.size(), 1u);
  EXPECT_EQ(grid.pointCount(), kMax - 10);
  EXPECT_EQ(grid[0].moments, corner(kMax - 10));
  EXPECT_EQ(grid.add(block(10, 20)), 30u);  // another cell has room
  EXPECT_EQ(grid.find({0, 0, 0})->count, kMax);
  EXPECT_EQ(grid.find({1, 1, 1})->count, 20);
  EXPECT_EQ(grid.add(block(0, 500)), 500u);
  EXPECT_THROW(grid.add(block(1, 0)), std::length_error);
  EXPECT_EQ(grid.pointCount(), kMax + 520);
}

TEST(CountLimit, OfMergedGridsIsThrown) {
  MomentGrid<3> grid(1.0), other(1.0);
  grid.add({0, 0, 0}, corner(kMax - 10));
  other.add({0, 0, 0}, corner(11));
  EXPECT_THROW(grid.merge(other), std::length_error);
  EXPECT_EQ(grid[0].moments, corner(kMax - 10));
}

}  // namespace
}  // namespace gaussmap
