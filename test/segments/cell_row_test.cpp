// SPDX-License-Identifier: BSD-3-Clause
#include "segments/cell_row.h"

#include <gtest/gtest.h>

namespace gaussmap::detail {
namespace {

CellRow randomRow(Random& random, int points) {
  CellRow row({1.0, 2.0}, {0.6, 0.8}, 0.1);
  for (int i = 0; i < points; ++i)
    row.add(Vector<2>(1.0, 2.0) + 3.0 * random.normal() * Vector<2>(0.6, 0.8), 1.0 + random.uniform());
  return row;
}

void expectSame(const LineMoments& a, const LineMoments& b) {
  EXPECT_NEAR(a.n, b.n, 1e-9);
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.xy, b.xy, 1e-8);
  EXPECT_NEAR(a.yy, b.yy, 1e-8);
}

TEST(CellRow, APointFallsToTheCellOfItsPosition) {
  CellRow row({10.0, 0.0}, {1.0, 0.0}, 0.5);
  row.add({9.9, 3.0}, 1.0);
  row.add({11.2, -1.0}, 2.0);
  EXPECT_EQ(row.first(), -1);
  EXPECT_EQ(row.last(), 3);
  EXPECT_DOUBLE_EQ(row.cells()[0].hits.n, 1.0);
  EXPECT_DOUBLE_EQ(row.cells()[1].hits.n, 0.0);
  EXPECT_DOUBLE_EQ(row.cells()[3].hits.n, 2.0);
}

TEST(CellRow, TurningAndAbsorbingLoseNothing) {
  Random random(2);
  const CellRow row = randomRow(random, 300), other = randomRow(random, 50);
  expectSame(row.turned({0.0, 0.0}, {0.8, 0.6}).total(), row.total());
  CellRow both = row;
  both.absorb(other);
  expectSame(both.total(), row.total() + other.total());
}

TEST(CellRow, SlicesShareTheEvidenceOut) {
  Random random(3);
  const CellRow row = randomRow(random, 100);
  for (std::size_t cut = 0; cut <= row.cells().size(); cut += 7) {
    const CellRow a = row.slice(0, cut), b = row.slice(cut, row.cells().size());
    expectSame(a.total() + b.total(), row.total());
    if (!a.empty()) {
      EXPECT_GT(a.cells().front().hits.n, 0.0);
      EXPECT_GT(a.cells().back().hits.n, 0.0);
    }
    if (!a.empty() && !b.empty()) {
      EXPECT_LE(a.last(), b.first());
    }
  }
}

TEST(CellRow, RaysThroughGoWhereTheirCellGoes) {
  CellRow row({0.0, 0.0}, {1.0, 0.0}, 0.1);
  row.at(3).crossed = 5.0;  // an empty cell
  row.at(0).hits.add({0.05, 0.0});
  row.at(0).crossed = 2.0;
  CellRow onto({0.0, 0.0}, {1.0, 0.0}, 0.1);
  onto.absorb(row);
  EXPECT_DOUBLE_EQ(onto.at(0).crossed, 2.0);
  EXPECT_DOUBLE_EQ(onto.at(3).crossed, 5.0);
}

}  // namespace
}  // namespace gaussmap::detail
