// SPDX-License-Identifier: BSD-3-Clause
// The search behind the Hausdorff distance, against all pairs, on clouds that are hard for trees.
#include "points/nearest_search.h"

#include <gtest/gtest.h>

#include "gaussmap/evaluation/hausdorff.h"
#include "points/nearest_distances.h"
#include "points/point_clouds.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::allPairs;
using test::cube;
using test::Points;

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

TEST(PointTree, HoldsEveryPointOnceInBoxesThatFit) {
  for (const test::CloudPair& pair : test::hostilePairs()) {
    SCOPED_TRACE(pair.name);
    const PointTree tree(pair.a);
    ASSERT_EQ(tree.size(), pair.a.size());
    std::vector<int> seen(pair.a.size());
    for (std::size_t i = 0; i < tree.size(); ++i) {
      ++seen[tree.index()[i]];
      for (std::size_t a = 0; a < 3; ++a)
        ASSERT_EQ(tree.axis(a)[i], pair.a[tree.index()[i]](static_cast<Eigen::Index>(a)));
    }
    EXPECT_EQ(seen, std::vector<int>(pair.a.size(), 1));
    for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
      const PointTree::Node& node = tree.nodes()[n];
      for (std::size_t a = 0; a < 3; ++a) {
        const double* const first = tree.axis(a) + node.first;
        ASSERT_EQ(node.low[a], *std::min_element(first, first + node.count));
        ASSERT_EQ(node.high[a], *std::max_element(first, first + node.count));
      }
      if (node.right == 0) {
        bool one_will_do = true;  // they are equal, or so near that squares of their differences are 0
        for (std::size_t a = 0; a < 3; ++a) one_will_do &= node.high[a] - node.low[a] < 1e-200;
        ASSERT_EQ(node.distinct, one_will_do ? 1 : node.count);
        ASSERT_TRUE(node.distinct <= PointTree::kLeafSize);
      } else {
        const PointTree::Node &left = tree.nodes()[n + 1], &right = tree.nodes()[node.right];
        ASSERT_EQ(left.first, node.first);
        ASSERT_EQ(right.first, left.first + left.count);
        ASSERT_EQ(left.count + right.count, node.count);
        ASSERT_GT(left.count, 0u);
        ASSERT_GT(right.count, 0u);
      }
    }
  }
}

void expectAllPairs(const Points& from, const Points& to) {
  const std::vector<double> found = nearestDistances(from, to), expected = allPairs(from, to);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) ASSERT_DOUBLE_EQ(found[i], expected[i]) << "point " << i;
}

TEST(NearestSearch, IsAllPairsOnHostileClouds) {
  for (const test::CloudPair& pair : test::hostilePairs()) {
    SCOPED_TRACE(pair.name);
    expectAllPairs(pair.a, pair.b);
    expectAllPairs(pair.b, pair.a);
  }
}

TEST(NearestSearch, FindsTheMaximumAloneToTheLastBitOnHostileClouds) {
  for (const test::CloudPair& pair : test::hostilePairs()) {
    SCOPED_TRACE(pair.name);
    for (const int threads : {1, 2, 0}) {
      const HausdorffMaxima maxima = hausdorffMaxima(pair.a, pair.b, threads);
      EXPECT_EQ(maxima.forward, largest(nearestDistances(pair.a, pair.b)));
      EXPECT_EQ(maxima.backward, largest(nearestDistances(pair.b, pair.a)));
      EXPECT_EQ(maxima.hausdorff(), std::max(maxima.forward, maxima.backward));
    }
  }
}

TEST(NearestSearch, GivesTheSameBitsForAnyNumberOfThreads) {
  for (const test::CloudPair& pair : test::hostilePairs()) {
    SCOPED_TRACE(pair.name);
    const std::vector<double> one = nearestDistances(pair.a, pair.b, 1);
    for (const int threads : {2, 3, 0}) EXPECT_EQ(nearestDistances(pair.a, pair.b, threads), one);
  }
}

TEST(NearestSearch, GivesTheSameBitsForAnyOrderOfTheTarget) {
  for (const test::CloudPair& pair : test::hostilePairs()) {
    SCOPED_TRACE(pair.name);
    EXPECT_EQ(nearestDistances(pair.a, Points(pair.b.rbegin(), pair.b.rend())), nearestDistances(pair.a, pair.b));
  }
}

TEST(NearestSearch, FindsOneOutlierAmongAHundredThousandPoints) {
  Points a = cube(100000, 20);
  const Points b = a;
  a[77777] = {30, 0.5, 0.5};
  const HausdorffMaxima maxima = hausdorffMaxima(a, b);
  EXPECT_DOUBLE_EQ(maxima.forward, allPairs({a[77777]}, b).front());
  EXPECT_DOUBLE_EQ(maxima.backward, allPairs({b[77777]}, a).front());
}

TEST(NearestSearch, HasTheMaximumOfAllDistancesOnManyRandomClouds) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const auto size = [&] { return 1 + static_cast<std::size_t>(1500 * random.uniform() * random.uniform()); };
    Points a = cube(size(), 2 * seed), b = cube(size(), 2 * seed + 1);
    for (Points* points : {&a, &b})  // cubes, slabs and rods of any size and place
      for (Vector<3>& point : *points)
        point =
            (point.array() * Vector<3>(1, std::pow(10.0, -double(seed % 4)), std::pow(10.0, -double(seed % 7))).array())
                .matrix();
    const HausdorffMaxima maxima = hausdorffMaxima(a, b);
    ASSERT_EQ(maxima.forward, largest(nearestDistances(a, b))) << "seed " << seed;
    ASSERT_EQ(maxima.backward, largest(nearestDistances(b, a))) << "seed " << seed;
  }
}

TEST(NearestSearch, FindsTheMaximumAtTheCornerOfABox) {  // where the bound of a box is all but exact
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Points diagonal = cube(3000, seed);
    for (Vector<3>& point : diagonal) point = Vector<3>::Constant(point.x());
    ASSERT_EQ(hausdorffMaxima(diagonal, {{0, 0, 0}}).forward, largest(nearestDistances(diagonal, {{0, 0, 0}})));
  }
}

/// Pairs of points looked at per query, a count instead of a clock: on these clouds a bad search looks at thousands.
double comparisonsEach(const Points& from, const Points& to) {
  std::size_t comparisons = 0;
  nearestDistances(PointTree(from), PointTree(to), 0, &comparisons);
  return double(comparisons) / double(from.size());
}

double comparisonsEachForTheMaximum(const Points& from, const Points& to) {
  std::size_t comparisons = 0;
  largestNearestDistance(PointTree(from), PointTree(to), 1, &comparisons);
  return double(comparisons) / double(from.size());
}

TEST(NearestSearch, EndsOnHeapsOfEqualPoints) {
  const Points heap(300000, Vector<3>(1, 2, 3)), other(300000, Vector<3>(1, 2, 4));
  EXPECT_EQ(largest(nearestDistances(heap, other)), 1.0);
  EXPECT_EQ(hausdorffMaxima(heap, other).backward, 1.0);
  EXPECT_EQ(hausdorffMaxima(heap, heap).backward, 0.0);
  EXPECT_LE(comparisonsEach(heap, other), 2.0);
  EXPECT_LE(comparisonsEachForTheMaximum(heap, other), 0.1);
}

TEST(NearestSearch, EndsOnAHeapOfAMicrometreBesideAnOutlier) {
  Points heap = cube(200000, 21);
  for (Vector<3>& point : heap) point *= 1e-6;
  heap.emplace_back(1e6, 0, 0);
  Points other = heap;
  for (Vector<3>& point : other) point.y() += 1e-9;
  EXPECT_LT(largest(nearestDistances(heap, other)), 2e-9);
  EXPECT_LT(comparisonsEach(heap, other), 60.0);
  EXPECT_LT(comparisonsEachForTheMaximum(heap, other), 60.0);
}

TEST(NearestSearch, EndsForPointsThatSeeAWallFromFarAway) {  // each group of them sees half the wall as near
  Points wall = cube(200000, 22), far = cube(20000, 23);
  for (Vector<3>& point : wall) point = Vector<3>(0, 20 * point.y(), 20 * point.z());
  for (Vector<3>& point : far) point = Vector<3>(100 + 50 * point.x(), 20 * point.y(), 20 * point.z());
  EXPECT_NEAR(largest(nearestDistances(far, wall)), 150, 0.1);
  EXPECT_LT(comparisonsEach(far, wall), 1300.0);
  EXPECT_LT(comparisonsEachForTheMaximum(far, wall), 20.0);
}

TEST(NearestSearch, LooksAtFewPairsOnALineAndWherePointsRepeat) {
  Points line = cube(100000, 30), other = cube(100000, 31), repeated;
  for (Points* points : {&line, &other})
    for (Vector<3>& point : *points) point = point.x() * Vector<3>(1, 2, -1);
  EXPECT_LT(comparisonsEach(line, other), 45.0);
  EXPECT_LT(comparisonsEachForTheMaximum(line, other), 45.0);
  const Points few = cube(1000, 32), many = cube(100000, 33);
  for (std::size_t i = 0; i < many.size(); ++i) repeated.push_back(few[i % few.size()]);
  EXPECT_LT(comparisonsEach(many, repeated), 20.0);
  EXPECT_LT(comparisonsEach(repeated, many), 50.0);
}

TEST(HausdorffMaxima, RefuseEmptySetsAndNameThePointThatIsNotFinite) {
  EXPECT_THROW(hausdorffMaxima({}, cube(1, 1)), std::invalid_argument);
  EXPECT_THROW(hausdorffMaxima(cube(1, 1), {}), std::invalid_argument);
  Points bad = cube(10, 24);
  bad[3].z() = std::numeric_limits<double>::infinity();
  try {
    hausdorffMaxima(cube(1, 1), bad);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("point 3 of 'b'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gaussmap
