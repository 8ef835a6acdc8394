// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/grid.h"

#include <gtest/gtest.h>

#include <limits>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
namespace {

TEST(Grid, HasCellsTenTimesWiderAtEachScaleOfThePaper) {
  const Grid<3> grid({0.1, 10, 3, 0.0});
  EXPECT_DOUBLE_EQ(grid.side(0), 0.1);
  EXPECT_DOUBLE_EQ(grid.side(1), 1.0);
  EXPECT_DOUBLE_EQ(grid.side(2), 10.0);
  EXPECT_DOUBLE_EQ(grid.options().noise, 0.005);
}

TEST(Grid, RoundsParentsDownAlsoBelowZero) {
  const Grid<3> grid({0.1, 10, 3, 0.0});
  EXPECT_EQ(grid.ancestor({-1, 0, 9}, 0, 1), (CellKey<3>{-1, 0, 0}));
  EXPECT_EQ(grid.ancestor({-10, 10, -11}, 0, 1), (CellKey<3>{-1, 1, -2}));
  EXPECT_EQ(grid.ancestor({-101, 99, 100}, 0, 2), (CellKey<3>{-2, 0, 1}));
  const std::int32_t lowest = std::numeric_limits<std::int32_t>::min();
  EXPECT_EQ(grid.ancestor({lowest, 0, 0}, 0, 1)[0], -214748365);
}

TEST(Grid, ParentOfTheParentIsTheGrandparent) {
  const Grid<3> grid({0.1, 3, 4, 0.0});
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    CellKey<3> key;
    for (std::int32_t& coordinate : key) coordinate = static_cast<std::int32_t>(random.bits());
    EXPECT_EQ(grid.ancestor(grid.ancestor(key, 0, 1), 1, 2), grid.ancestor(key, 0, 2));
  }
}

TEST(Grid, CentresOfChildrenLieRoundTheCentreOfTheParent) {
  const Grid<2> grid({0.5, 2, 2, 0.0});
  EXPECT_EQ(grid.centre({-1, 3}, 0), (Vector<2>(-0.25, 1.75)));
  EXPECT_EQ(grid.centreInParent({-1, 3}, 0), (Vector<2>(0.25, 0.25)));
  EXPECT_EQ(grid.centre(grid.ancestor({-1, 3}, 0, 1), 1), (Vector<2>(-0.5, 1.5)));
}

TEST(Grid, KnowsParentsWithoutDividing) {
  Random random(11);
  for (const int ratio : {2, 3, 10, 1000}) {
    const Grid<3> grid({0.1, ratio, 2, 0.0});
    for (int trial = 0; trial < 10000; ++trial) {
      CellKey<3> key, other;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int extent = random.below(4) == 0 ? 2147483647 : 3 * ratio;
        key[axis] = static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(2 * std::int64_t{extent} + 1)) -
                                              static_cast<std::uint64_t>(extent));
        other[axis] = random.below(3) == 0 ? key[axis] : static_cast<std::int32_t>(random.below(9)) - 4;
      }
      const CellKey<3> parent = grid.ancestor(key, 0, 1);
      EXPECT_TRUE(grid.isParent(parent, key)) << toString<3>(key);
      const CellKey<3> others = grid.ancestor(other, 0, 1);
      EXPECT_EQ(grid.isParent(others, key), others == parent) << toString<3>(key) << toString<3>(other);
      EXPECT_EQ(grid.centreInParent(key, parent, 0), grid.centreInParent(key, 0));
    }
  }
}

TEST(Grid, CellOfItsCentreIsTheCell) {
  const Grid<3> grid({0.1, 10, 3, 0.0});
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    CellKey<3> key;
    for (std::int32_t& coordinate : key) coordinate = static_cast<std::int32_t>(random.bits()) / 1000;
    for (int scale = 0; scale < 3; ++scale) EXPECT_EQ(grid.keyOf(grid.centre(key, scale), scale), key);
  }
}

TEST(Grid, KnowsTheBoxOfACell) {
  const Box<2> box = Grid<2>({0.5, 4, 2, 0.0}).boxOf({1, -1}, 1);  // cells of 2 m
  EXPECT_EQ(box.low, Vector<2>(2.0, -2.0));
  EXPECT_EQ(box.high, Vector<2>(4.0, 0.0));
}

TEST(Box, ContainsItsLowSidesButNotItsHighSides) {
  const Box<2> box{{0.0, 1.0}, {2.0, 3.0}};
  EXPECT_TRUE(isInBox<2>(box, {0.0, 1.0}));
  EXPECT_TRUE(isInBox<2>(box, {1.0, 2.5}));
  EXPECT_FALSE(isInBox<2>(box, {2.0, 2.0}));
  EXPECT_FALSE(isInBox<2>(box, {1.0, 3.0}));
  EXPECT_FALSE(isInBox<2>(box, {std::numeric_limits<double>::quiet_NaN(), 2.0}));
}

TEST(Grid, RefusesPointsThatHaveNoCell) {
  const Grid<3> grid({0.1, 10, 3, 0.0});
  EXPECT_THROW(grid.keyOf({1e12, 0, 0}), std::out_of_range);
  EXPECT_THROW(grid.keyOf({0, std::numeric_limits<double>::quiet_NaN(), 0}), std::out_of_range);
  EXPECT_NO_THROW(grid.keyOf({2e8, -2e8, 0}));
}

TEST(Grid, RefusesOptionsThatMakeNoMapAndNamesThem) {
  const auto messageFor = [](const MapOptions& options) -> std::string {
    try {
      const Grid<3> grid(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(messageFor({0.0, 10, 3, 0.0}).find("resolution"), std::string::npos);
  EXPECT_NE(messageFor({-1.0, 10, 3, 0.0}).find("resolution"), std::string::npos);
  EXPECT_NE(messageFor({0.1, 1, 3, 0.0}).find("ratio"), std::string::npos);
  EXPECT_NE(messageFor({0.1, 10, 0, 0.0}).find("scales"), std::string::npos);
  EXPECT_NE(messageFor({0.1, 10, 12, 0.0}).find("scales"), std::string::npos);
  EXPECT_NE(messageFor({0.1, 10, 3, -0.1}).find("noise"), std::string::npos);
  EXPECT_NE(messageFor({0.1, 10, 3, 1e-9}).find("noise"), std::string::npos);
  EXPECT_EQ(messageFor({0.1, 2, 16, 0.0}), "");
}

}  // namespace
}  // namespace gaussmap
