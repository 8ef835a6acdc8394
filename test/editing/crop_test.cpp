// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/crop.h"

#include <gtest/gtest.h>

#include <limits>

#include "editing/thinned_map.h"
#include "gaussmap/editing/merge_maps.h"
#include "gaussmap/map/queries.h"
#include "io/gmap/map_equality.h"
#include "map/inherit_occupancy.h"
#include "mapping/map_checks.h"

namespace gaussmap::test {
using namespace detail;

namespace {

TEST(Crop, CutsPartsThatMergeToTheWholeAgain) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(9000, 1), smallGrid<3>());
  GaussianMap<3> merged(map.options());
  for (double x = -9.0; x < 9.0; x += 1.5) {
    const Box<3> box{{x, -9.0, -9.0}, {x + 1.5, 9.0, 9.0}};
    const GaussianMap<3> part = crop<3>(map, [&](const Vector<3>& p) { return isInBox<3>(box, p); });
    EXPECT_TRUE(part.acceptsScans());
    expectMomentMatches<3>(part);
    merged = mergeMaps<3>(merged, part);
  }
  expectSameMap<3>(merged, map);
}

TEST(Crop, KeepsWhatLiesInsideAsItWas) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(9000, 1), smallGrid<3>());
  const auto isInside = [](const Vector<3>& p) { return p.x() + 0.3 * p.y() < 0.2; };
  const GaussianMap<3> part = crop<3>(map, isInside);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) inside += isInside(map.gaussian(i, 0).mean) ? 1 : 0;
  EXPECT_EQ(part.gaussianCount(0), inside);
  EXPECT_GT(inside, 100u);
  for (std::size_t i = 0; i < part.gaussianCount(0); ++i) {
    const auto old = map.find(part.scale(0).keys[i], 0);
    ASSERT_TRUE(old);
    ASSERT_EQ(part.scale(0).moments[i], map.scale(0).moments[*old]);
  }
  expectMomentMatches<3>(part);
  for (int s = 0; s < 3; ++s) EXPECT_EQ(part.weight(s), part.weight(0));
  expectSameMap<3>(crop<3>(map, [](const Vector<3>&) { return true; }), map);
  EXPECT_TRUE(crop<3>(map, [](const Vector<3>&) { return false; }).empty());
}

TEST(Crop, CutsCompressedMapsByWhatTheyHave) {
  const GaussianMap<2> map = thinned<2>(refinedMap<2>(randomCloud<2>(9000, 1), smallGrid<2>()));
  const auto isInside = [](const Vector<2>& p) { return p.x() > 0.1; };
  const GaussianMap<2> part = crop<2>(map, isInside);
  std::size_t expected = 0;
  for (const GaussianId& leaf : leaves(map)) expected += isInside(map.gaussian(leaf.index, leaf.scale).mean) ? 1 : 0;
  EXPECT_EQ(leaves(part).size(), expected);
  for (const GaussianId& leaf : leaves(part)) EXPECT_TRUE(isInside(part.gaussian(leaf.index, leaf.scale).mean));
  expectMomentMatches<2>(part);
}

TEST(Crop, KeepsTheOccupancyOfWhatStays) {
  GaussianMap<3> map = build<3>({{0.05, 0.05, 0.05}, {0.15, 0.05, 0.05}}, smallGrid<3>());
  map = withOccupancy<3>(map, {-1.0f, 2.0f});
  const GaussianMap<3> part = crop<3>(map, [](const Vector<3>& p) { return p.x() < 0.1; });
  ASSERT_EQ(part.gaussianCount(0), 1u);
  for (int s = 0; s < 3; ++s) EXPECT_EQ(part.logOdds(0, s), -1.0f);
}

TEST(Polygon, ContainsWhatItsCornersEnclose) {
  const Polygon shape({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}});  // a notch from above
  EXPECT_TRUE(shape.contains(1.0, 1.0));
  EXPECT_TRUE(shape.contains(3.5, 2.5));
  EXPECT_FALSE(shape.contains(2.0, 2.0));
  EXPECT_FALSE(shape.contains(-0.1, 1.0));
  EXPECT_FALSE(shape.contains(4.1, 1.0));
  EXPECT_FALSE(shape.contains(1.0, -0.1));
}

TEST(Polygon, SharesNoPointWithItsNeighbours) {
  // A fan of triangles around a corner covers a square once, whatever the order of the corners.
  const std::vector<Vector<2>> rim = {{0, 0}, {3, 0}, {4, 1}, {4, 4}, {1, 4}, {0, 2}};
  const Vector<2> middle(1.7, 1.3);
  std::vector<Polygon> fan;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vector<2>&a = rim[i], &b = rim[(i + 1) % rim.size()];
    fan.push_back(i % 2 == 0 ? Polygon({a, b, middle}) : Polygon({middle, b, a}));
  }
  const Polygon whole(rim);
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    Vector<2> p(5.0 * random.uniform() - 0.5, 5.0 * random.uniform() - 0.5);
    if (i % 4 == 0) p = rim[i / 4 % 6] + (middle - rim[i / 4 % 6]) * random.uniform();  // on a side, but for rounding
    if (i % 8 == 1) p = {0.5 * double(i % 9), 0.5 * double(i % 11)};
    int times = 0;
    for (const Polygon& triangle : fan) times += triangle.contains(p.x(), p.y()) ? 1 : 0;
    ASSERT_EQ(times, whole.contains(p.x(), p.y()) ? 1 : 0) << p.transpose();
  }
}

TEST(Polygon, RefusesCornersThatEncloseNothing) {
  EXPECT_THROW(Polygon({{0, 0}, {1, 1}}), std::invalid_argument);
  EXPECT_THROW(Polygon({{0, 0}, {1, 1}, {std::numeric_limits<double>::quiet_NaN(), 2}}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap::test
