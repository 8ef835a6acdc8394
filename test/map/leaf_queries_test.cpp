// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/queries.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "editing/keep_cells.h"
#include "gaussmap/mapping/build.h"
#include "map/random_clouds.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Three points in two cells of 1 m; of the cells of 0.1 m under the second one nothing is left.
GaussianMapOctree halfCompressed() {
  const GaussianMapOctree map = build<3>({{0.05, 0.05, 0.05}, {1.05, 0.0, 0.0}, {1.95, 0.0, 0.0}}, {0.1, 10, 2, 0.0});
  return keepCells<3>(map, {{true, false, false}, {true, true}});
}

TEST(Leaves, AreTheFinestGaussiansAndTheCellsThatStandAlone) {
  EXPECT_EQ(leaves<3>(halfCompressed()), (std::vector<GaussianId>{{0, 0}, {1, 1}}));
}

TEST(Leaves, OfAMapThatIsNotCompressedAreItsFinestScale) {
  const GaussianMapOctree map = build<3>(test::randomCloud<3>(1000, 51), {0.1, 4, 3, 0.0});
  EXPECT_EQ(leaves<3>(map), gaussiansOfScale<3>(map, 0));
  EXPECT_TRUE(leaves<3>(GaussianMapOctree()).empty());
}

TEST(Leaves, OfAScaleAreItsGaussians) {
  const GaussianMapOctree map = halfCompressed();
  EXPECT_EQ(gaussiansOfScale<3>(map, 1), (std::vector<GaussianId>{{1, 0}, {1, 1}}));
  EXPECT_EQ(gaussiansOfScale<3>(map, 0), (std::vector<GaussianId>{{0, 0}}));
  EXPECT_THROW(gaussiansOfScale<3>(map, 2), std::out_of_range);
  EXPECT_THROW(gaussiansOfScale<3>(map, -1), std::out_of_range);
}

TEST(Leaves, AreCountedPerScale) {
  const GaussianMapOctree map = halfCompressed();
  const LeafCounts fine = leafCounts<3>(map, 0), coarse = leafCounts<3>(map, 1);
  EXPECT_EQ(fine.cells, 1u);
  EXPECT_EQ(fine.gaussians, 1u);
  EXPECT_EQ(fine.weight, 1.0);
  EXPECT_EQ(coarse.cells, 1u);
  EXPECT_EQ(coarse.gaussians, 1u);
  EXPECT_EQ(coarse.weight, 2.0);
}

TEST(Extent, OfACompressedMapIsTheBoxOfItsLeaves) {
  const auto extent = extentOf<3>(halfCompressed());
  ASSERT_TRUE(extent);
  EXPECT_LT((extent->low - Vector<3>(0, 0, 0)).norm(), 1e-12);   // the finest cell begins there, and so does the coarse
  EXPECT_LT((extent->high - Vector<3>(2, 1, 1)).norm(), 1e-12);  // where the coarse cell ends
}

TEST(Extent, OfAMapIsTheBoxOfItsFinestCells) {
  const auto extent = extentOf<3>(build<3>({{0.05, -0.05, 0.05}, {1.95, 0.05, 0.55}}, {0.1, 10, 3, 0.0}));
  ASSERT_TRUE(extent);
  EXPECT_LT((extent->low - Vector<3>(0, -0.1, 0)).norm(), 1e-12);
  EXPECT_LT((extent->high - Vector<3>(2, 0.1, 0.6)).norm(), 1e-12);
  EXPECT_FALSE(extentOf<3>(GaussianMapOctree()));
}

}  // namespace
}  // namespace gaussmap
