// SPDX-License-Identifier: BSD-3-Clause
#include "editing/keep_cells.h"

#include <gtest/gtest.h>

#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/gmap/map_equality.h"
#include "map/random_clouds.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::randomCloud;
using test::sameGaussian;

/// Drops what is under about a third of the cells of every coarse scale.
template <int D>
std::vector<std::vector<char>> randomCells(const GaussianMap<D>& map, Random& random) {
  std::vector<std::vector<char>> keep(std::size_t(map.scales()));
  keep.back().assign(map.cellCount(map.scales() - 1), true);
  for (int s = map.scales() - 1; s > 0; --s) {
    const auto at = static_cast<std::size_t>(s);
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell)
      keep[at - 1].insert(keep[at - 1].end(), map.childCells(cell, s).size(), keep[at][cell] && random.below(3) > 0);
  }
  return keep;
}

template <int D>
void expectWhatStaysToBeAsItWas(const GaussianMap<D>& map) {
  Random random(8);
  const auto keep = randomCells(map, random);
  const GaussianMap<D> thin = keepCells(map, keep);
  for (int s = 0; s < map.scales(); ++s) {
    std::size_t cells = 0;
    double weight = 0.0;
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      const auto place = thin.find(map.scale(s).keys[cell], s);
      ASSERT_EQ(place.has_value(), bool(keep[std::size_t(s)][cell]));
      if (!place) continue;
      ++cells;
      const IndexRange before = map.gaussiansOf(cell, s), after = thin.gaussiansOf(*place, s);
      ASSERT_EQ(after.size(), before.size());
      for (std::size_t k = 0; k < before.size(); ++k) {
        const std::size_t was = before.first + k, is = after.first + k;
        EXPECT_TRUE(sameGaussian<D>(thin.localGaussian(is, s), map.localGaussian(was, s)));
        weight += map.localGaussian(was, s).weight;
        if (s + 1 == map.scales()) continue;
        EXPECT_TRUE(sameGaussian<D>(thin.localGaussian(thin.parentOf(is, s), s + 1),
                                    map.localGaussian(map.parentOf(was, s), s + 1)));
      }
    }
    EXPECT_EQ(thin.cellCount(s), cells);
    EXPECT_NEAR(thin.weight(s), weight, 1e-9 * weight);
  }
}

TEST(KeepCells, LeavesWhatStaysAsItWas) {
  const GaussianMapOctree map = build<3>(randomCloud<3>(4000, 71), {0.1, 3, 4, 0.0});
  expectWhatStaysToBeAsItWas<3>(map);
  expectWhatStaysToBeAsItWas<3>(refine<3>(map).map);
}

TEST(KeepCells, LeavesWhatStaysAsItWasInThePlane) {
  expectWhatStaysToBeAsItWas<2>(build<2>(randomCloud<2>(3000, 72), {0.1, 4, 3, 0.0}));
}

TEST(KeepCells, OfAllCellsIsTheMap) {
  const GaussianMapOctree map = refine<3>(build<3>(randomCloud<3>(2000, 73), {0.1, 4, 3, 0.0})).map;
  std::vector<std::vector<char>> all;
  for (int s = 0; s < 3; ++s) all.emplace_back(map.cellCount(s), true);
  test::expectSameMap<3>(keepCells<3>(map, all), map);
}

}  // namespace
}  // namespace gaussmap
