// SPDX-License-Identifier: BSD-3-Clause
// The errors of eq. (6) per cell and per finer Gaussian, known on paper and from cellError().
#include <algorithm>
#include <cmath>

#include "gaussmap/editing/compress.h"
#include "map/random_clouds.h"
#include "mapping/refine_helpers.h"

namespace gaussmap {
namespace {

/// Two cells of 4 m over cells of 1 m. Left: finer Gaussians at x = 0.5 and 2.5 with deviations 0.1 and 0.2, and
/// clusters at x = 1.5 (`clusters` = 1) or at 0.5 and 1.5 (2). Right: one Gaussian that its cluster represents exactly.
template <int D>
GaussianMap<D> twoCells(int clusters) {
  const auto key = [](int x) {
    CellKey<D> cell{};
    cell[0] = x;
    return cell;
  };
  const auto at = [](double x, double deviation, double weight) {
    Gaussian<D> gaussian{Vector<D>::Zero(), deviation * deviation * Matrix<D>::Identity(), weight};
    gaussian.mean.x() = x;  // relative to the centre of the cell
    return gaussian;
  };
  MapScale<D> fine, coarse;
  fine.keys = {key(0), key(2), key(5)};
  fine.gaussians = {at(0.0, 0.1, 1), at(0.0, 0.2, 1), at(0.2, 0.1, 3)};
  coarse.keys = {key(0), key(1)};
  coarse.first_child = {0, 2, 3};
  if (clusters == 1) {
    coarse.gaussians = {at(-0.5, 1.0, 2), at(-0.3, 0.1, 3)};
    fine.parent = {0, 0, 1};
  } else {
    coarse.first_gaussian = {0, 2, 3};
    coarse.gaussians = {at(-1.5, 0.1, 1), at(-0.5, 0.2, 1), at(-0.3, 0.1, 3)};
    fine.parent = {0, 1, 2};
  }
  // The other coordinates of the means differ: a finer centre is at 0.5, a coarse one at 2.
  for (Gaussian<D>& gaussian : coarse.gaussians) gaussian.mean.template tail<D - 1>().setConstant(-1.5);
  return GaussianMap<D>({1.0, 4, 2, 0.0}, {fine, coarse});
}

template <int D>
void expectTheErrorsOfThePaper() {
  const CellErrors one = cellErrors(twoCells<D>(1), 1);  // 1 m is 10 deviations of the first, 5 of the second
  ASSERT_EQ(one.contributions.size(), 3u);
  ASSERT_EQ(one.cells.size(), 2u);
  EXPECT_NEAR(one.contributions[0], 100.0, 1e-9);
  EXPECT_NEAR(one.contributions[1], 25.0, 1e-9);
  EXPECT_NEAR(one.contributions[2], 0.0, 1e-9);
  EXPECT_NEAR(one.cells[0], 62.5, 1e-9);
  EXPECT_NEAR(one.cells[1], 0.0, 1e-9);
  const CellErrors two = cellErrors(twoCells<D>(2), 1);  // the nearest cluster counts, not the parent
  EXPECT_NEAR(two.contributions[0], 0.0, 1e-9);
  EXPECT_NEAR(two.contributions[1], 25.0, 1e-9);
  EXPECT_NEAR(two.cells[0], 12.5, 1e-9);
}

TEST(CellErrors, AreSquaredDistancesInDeviationsOfTheFinerGaussians) {
  expectTheErrorsOfThePaper<2>();
  expectTheErrorsOfThePaper<3>();
}

template <int D>
void expectEqualToCellError(const GaussianMap<D>& map) {
  for (int s = 1; s < map.scales(); ++s) {
    const CellErrors errors = cellErrors(map, s);
    ASSERT_EQ(errors.cells.size(), map.cellCount(s));
    ASSERT_EQ(errors.contributions.size(), map.gaussianCount(s - 1));
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      std::vector<Gaussian<D>> clusters, data;
      const IndexRange own = map.gaussiansOf(cell, s), under = map.gaussiansUnder(cell, s);
      for (std::size_t i = own.first; i < own.last; ++i) clusters.push_back(map.gaussian(i, s));
      double sum = 0.0;
      for (std::size_t j = under.first; j < under.last; ++j) {
        data.push_back(map.gaussian(j, s - 1));
        sum += errors.contributions[j];
        EXPECT_NEAR(errors.contributions[j], cellError(clusters, {data.back()}), 1e-6 * errors.contributions[j] + 1e-9);
      }
      EXPECT_NEAR(errors.cells[cell], cellError(clusters, data), 1e-6 * errors.cells[cell] + 1e-9);
      EXPECT_NEAR(errors.cells[cell], sum / double(under.size()), 1e-9 * errors.cells[cell]);
    }
    const CellErrors again = cellErrors(map, s, 1);
    EXPECT_EQ(errors.cells, again.cells);
    EXPECT_EQ(errors.contributions, again.contributions);
  }
}

TEST(CellErrors, AreThoseOfCellErrorInRefinedMaps) {
  expectEqualToCellError<3>(refine(roomMap(), PerCell{3.0}).map);
  expectEqualToCellError<2>(refine(build<2>(test::randomCloud<2>(3000, 5), {0.05, 4, 3, 0.0}), PerCell{2.0}).map);
}

TEST(CellErrors, AreNotANumberForCellsWithoutFinerOnes) {
  const GaussianMap<3> map = compress(refine(roomMap(), PerCell{6.0}).map, 0.3);
  ASSERT_TRUE(map.isCompressed());
  for (int s = 1; s < map.scales(); ++s) {
    const CellErrors errors = cellErrors(map, s);
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell)
      EXPECT_EQ(std::isnan(errors.cells[cell]), map.isLeaf(cell, s));
    EXPECT_TRUE(std::none_of(errors.contributions.begin(), errors.contributions.end(),
                             [](double contribution) { return !(contribution >= 0.0); }));
  }
}

TEST(CellErrors, RefuseScalesWithoutAFinerOne) {
  const GaussianMap<3> map = roomMap(100);
  for (const int scale : {-1, 0, 3}) EXPECT_THROW(cellErrors(map, scale), std::out_of_range);
}

}  // namespace
}  // namespace gaussmap
