// SPDX-License-Identifier: BSD-3-Clause
#include "registration/map_neighbours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/editing/compress.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Of every scale of a map with points from 0 to 4 m, and 2 m upwards.
void expectTheNearest(const GaussianMapOctree& map) {
  Random random(3);
  const Vector<3> origin(1.0, 2.0, 0.5);
  for (const int scale : {0, 1, 2}) {
    const double blur = 0.1, side = map.grid().side(scale);
    MapNeighbours near(map, scale, origin);
    near.setBlur(1.0);  // what is found before does not stay
    near.listAt(Vector<3>::Zero());
    near.setBlur(blur);
    std::uint32_t list = MapNeighbours::kNone;  // of the point before: a hint that is wrong nearly always
    for (int k = 0; k < 200; ++k) {
      const Vector<3> point(5 * random.uniform() - 0.5, 5 * random.uniform() - 0.5, 3 * random.uniform() - 0.5);
      double least = std::numeric_limits<double>::infinity();
      Vector<3> brute = Vector<3>::Zero();
      for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) {
        const Vector<3> centre = map.grid().centre(map.scale(scale).keys[map.cellOf(i, scale)], scale);
        if ((centre - point).cwiseAbs().maxCoeff() > side) continue;  // of the cell or the nearer one beside it
        Gaussian<3> wide = map.gaussian(i, scale);
        wide.cov += blur * blur * Matrix<3>::Identity();
        const double squared = mahalanobisSquared<3>(point, wide);
        if (squared >= least) continue;
        least = squared;
        brute = wide.mean;
      }
      const std::uint32_t found = near.nearest(list = near.listAt(point - origin, list), point - origin);
      ASSERT_EQ(found == MapNeighbours::kNone, std::isinf(least));
      if (found == MapNeighbours::kNone) continue;
      near.prepare(found);
      EXPECT_LT((near[found].mean + origin - brute).norm(), 1e-9);
    }
  }
  MapNeighbours near(map, 0, origin);
  EXPECT_EQ(near.listAt(Vector<3>(1e300, 0, 0)), MapNeighbours::kNone);
}

std::vector<Vector<3>> pointsWithin(const Vector<3>& size) {
  Random random(2);
  std::vector<Vector<3>> points;
  for (int i = 0; i < 3000; ++i)
    points.push_back(size.cwiseProduct(Vector<3>(random.uniform(), random.uniform(), random.uniform())));
  return points;
}

TEST(MapNeighbours, FindTheNearestOfTheEightCellsAroundAPoint) {
  expectTheNearest(build<3>(pointsWithin({4, 4, 2}), {0.5, 2, 3, 0.0}));
}

TEST(MapNeighbours, FindWhatIsLeftOfACompressedMap) {
  std::vector<Vector<3>> points = pointsWithin({4, 4, 0.01});  // flat on one side, a cloud on the other
  for (const Vector<3>& point : pointsWithin({2, 4, 2})) points.push_back(point);
  const GaussianMapOctree map = compress(build<3>(points, {0.5, 2, 3, 0.0}), 0.33);
  ASSERT_TRUE(map.isCompressed());
  ASSERT_GT(map.gaussianCount(0), 0u);
  expectTheNearest(map);
}

TEST(MapNeighbours, KeepAListAsLongAsThePointIsNearestToItsCorner) {
  const GaussianMapOctree map = build<3>({{0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}}, {0.5, 2, 2, 0.0});
  MapNeighbours near(map, 0, Vector<3>(0.3, 0.2, 0.1));
  const Vector<3> corner = Vector<3>(0.5, 0.5, 0.5) - Vector<3>(0.3, 0.2, 0.1);
  const std::uint32_t list = near.listAt(corner);
  EXPECT_EQ(near.listAt(corner + Vector<3>(0.24, -0.24, 0.24), list), list);
  EXPECT_EQ(near.listAt(corner + Vector<3>(0.24, -0.24, 0.24)), list);
  for (int axis = 0; axis < 3; ++axis)
    for (const double beyond : {-0.26, 0.26})
      EXPECT_NE(near.listAt(corner + beyond * Vector<3>::Unit(axis), list), list) << axis;
}

TEST(MapNeighbours, AtTheLastCellHaveNoneBeyondIt) {
  const double last = 0.5 * (std::pow(2.0, 31) - 0.5);  // in the last cell of 32 bits
  const GaussianMapOctree map = build<3>({{last, 0.1, 0.1}, {-last, 2.1, 0.1}}, {0.5, 2, 2, 0.0});
  MapNeighbours near(map, 0, Vector<3>(last, 0, 0));
  for (const double off : {-0.3, 0.0, 0.2}) {
    const std::uint32_t list = near.listAt(Vector<3>(off, 0.1, 0.1));
    ASSERT_NE(list, MapNeighbours::kNone) << off;
    EXPECT_NE(near.nearest(list, Vector<3>(off, 0.1, 0.1)), MapNeighbours::kNone) << off;
  }
  const Vector<3> at_end(0.2, 2.1, 0.1);  // the first cell of that row does not follow the last one
  EXPECT_EQ(near.nearest(near.listAt(at_end), at_end), MapNeighbours::kNone);
  EXPECT_EQ(near.listAt(Vector<3>(1.0, 0.1, 0.1)), MapNeighbours::kNone);
}

}  // namespace
}  // namespace gaussmap
