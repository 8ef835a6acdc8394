// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_scale_builder.h"

#include <gtest/gtest.h>

namespace gaussmap {
using namespace detail;
namespace {

Gaussian<2> ofWeight(double weight) {
  return {Vector<2>::Zero(), Matrix<2>::Identity(), weight};
}

TEST(MapScaleBuilder, LeavesStartsEmptyWhereEveryCellHoldsOneGaussian) {
  MapScaleBuilder<2> builder;
  for (int x = 0; x < 3; ++x) {
    builder.addCell({x, 0});
    builder.addGaussian(ofWeight(1.0));
  }
  const MapScale<2> scale = builder.take();
  EXPECT_EQ(scale.keys.size(), 3u);
  EXPECT_EQ(scale.gaussianCount(), 3u);
  EXPECT_TRUE(scale.first_gaussian.empty());
  EXPECT_TRUE(scale.log_odds.empty());
  EXPECT_TRUE(scale.parent.empty());
  EXPECT_TRUE(scale.first_child.empty());
  EXPECT_EQ(builder.cells(), 0u);
  EXPECT_EQ(builder.gaussians(), 0u);
}

TEST(MapScaleBuilder, NotesStartsWhereverTheFirstCellWithSeveralGaussiansIs) {
  for (int several = 0; several < 4; ++several) {
    MapScaleBuilder<2> builder;
    std::vector<std::uint32_t> starts;
    for (int x = 0; x < 4; ++x) {
      builder.addCell({x, 0});
      starts.push_back(static_cast<std::uint32_t>(builder.gaussians()));
      for (int i = 0; i < (x == several ? 3 : 1); ++i) builder.addGaussian(ofWeight(1.0));
    }
    starts.push_back(6);
    EXPECT_EQ(builder.take().first_gaussian, starts);
  }
}

TEST(MapScaleBuilder, GivesAnEmptyScaleWithoutCells) {
  const MapScale<3> scale = MapScaleBuilder<3>().take();
  EXPECT_TRUE(scale.keys.empty());
  EXPECT_TRUE(scale.first_gaussian.empty());
  EXPECT_EQ(MapScaleBuilder<3>().take(0).first_child, std::vector<std::uint32_t>{0});
}

TEST(MapScaleBuilder, CopiesCellsWithTheirColumns) {
  MapScaleBuilder<2> builder;
  for (int x = 0; x < 3; ++x) {
    builder.addCell({x, 1});
    for (int i = 0; i <= x % 2; ++i) {
      builder.addGaussian(ofWeight(10.0 * x + i + 1.0));
      builder.addLogOdds(static_cast<float>(x));
    }
  }
  const MapScale<2> from = builder.take();
  for (std::size_t cell = 0; cell < 3; ++cell) builder.copyCell(from, cell);
  const MapScale<2> copy = builder.take();
  EXPECT_EQ(copy.keys, from.keys);
  EXPECT_EQ(copy.first_gaussian, from.first_gaussian);
  EXPECT_EQ(copy.log_odds, from.log_odds);
  ASSERT_EQ(copy.gaussians.size(), from.gaussians.size());
  for (std::size_t i = 0; i < copy.gaussians.size(); ++i) EXPECT_EQ(copy.gaussians[i].weight, from.gaussians[i].weight);
}

TEST(MapScaleBuilder, CountsMomentsAsTheOnlyGaussianOfACell) {
  MapScale<3> from;
  from.keys = {{0, 0, 0}, {1, 0, 0}};
  from.moments.resize(2);
  from.moments[1].count = 7;
  MapScaleBuilder<3> builder;
  builder.copyCell(from, 1);
  const MapScale<3> copy = builder.take();
  EXPECT_EQ(copy.moments.front().count, 7);
  EXPECT_TRUE(copy.gaussians.empty());
  EXPECT_TRUE(copy.first_gaussian.empty());
}

}  // namespace
}  // namespace gaussmap
