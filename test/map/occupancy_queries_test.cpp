// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/queries.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "gaussmap/mapping/build.h"
#include "map/inherit_occupancy.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Points in cells 0, 3 and 20 along x.
GaussianMapOctree threeCells() {
  return build<3>(std::vector<Vector<3>>{{0.5, 0.5, 0.5}, {3.5, 0.5, 0.5}, {20.5, 0.5, 0.5}}, {1.0, 10, 2, 0.0});
}

TEST(LogOddsAt, AreThoseOfTheCellAtThePoint) {
  const GaussianMapOctree map = withOccupancy<3>(threeCells(), {-2.0f, 3.0f, -0.5f});
  EXPECT_EQ(logOddsAt<3>(map, {0.1, 0.9, 0.2}), -2.0f);
  EXPECT_EQ(logOddsAt<3>(map, {3.9, 0.1, 0.2}), 3.0f);
  EXPECT_EQ(logOddsAt<3>(map, {20.0, 0.1, 0.2}), -0.5f);
}

TEST(LogOddsAt, AreNoneWhereTheMapHasNoCell) {
  const GaussianMapOctree map = withOccupancy<3>(threeCells(), {-2.0f, 3.0f, -0.5f});
  EXPECT_FALSE(logOddsAt<3>(map, {5.5, 0.5, 0.5}));  // under a coarse cell that has others
  EXPECT_FALSE(logOddsAt<3>(map, {55.5, 0.5, 0.5}));
  EXPECT_FALSE(logOddsAt<3>(map, {1e300, 0, 0}));
  EXPECT_FALSE(logOddsAt<3>(map, {std::numeric_limits<double>::quiet_NaN(), 0, 0}));
  EXPECT_FALSE(logOddsAt<3>(GaussianMapOctree(), {0, 0, 0}));
}

TEST(LogOddsAt, AreTheMostInAMapThatSawNoMiss) {
  EXPECT_EQ(logOddsAt<3>(threeCells(), {0.1, 0.9, 0.2}), kMaxOccupancy);
}

}  // namespace
}  // namespace gaussmap
