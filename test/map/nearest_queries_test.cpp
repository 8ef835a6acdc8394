// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "gaussmap/editing/compress.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

using test::randomCloud;
using List = std::vector<FoundGaussian>;

bool inOrder(const FoundGaussian& a, const FoundGaussian& b) {
  return std::tie(a.distance, a.id.scale, a.id.index) < std::tie(b.distance, b.id.scale, b.id.index);
}

/// Returns some Gaussians in the order of results.
template <int D>
List allInOrder(const GaussianMap<D>& map, const Vector<D>& point, const std::vector<GaussianId>& ids) {
  List all;
  for (const GaussianId& id : ids) all.push_back({id, (map.gaussian(id.index, id.scale).mean - point).norm()});
  std::sort(all.begin(), all.end(), inOrder);
  return all;
}

/// Compares results with the first Gaussians of `all`. Distances may differ by rounding, so Gaussians at practically
/// equal distances may stand in another order.
void expectFirst(const List& found, const List& all, std::size_t count) {
  ASSERT_EQ(found.size(), count);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), inOrder));
  for (std::size_t i = 0; i < count; ++i) {
    const double rounding = 1e-12 * (1.0 + all[i].distance);
    ASSERT_NEAR(found[i].distance, all[i].distance, rounding) << i;
    const bool same = std::any_of(all.begin(), all.end(), [&](const FoundGaussian& other) {
      return other.id == found[i].id && std::abs(other.distance - found[i].distance) <= rounding;
    });
    ASSERT_TRUE(same) << i;
  }
}

/// Returns a radius that no mean is close to, with about `count` means within it.
double radiusFor(const List& all, std::size_t count) {
  count = std::min(count, all.size() - 1);
  return count == 0 ? 0.5 * all[0].distance : 0.5 * (all[count - 1].distance + all[count].distance);
}

std::size_t countWithin(const List& all, double radius) {
  return std::size_t(
      std::count_if(all.begin(), all.end(), [&](const auto& found) { return found.distance <= radius; }));
}

template <int D>
void expectTheBruteForceResults(const GaussianMap<D>& map, const Vector<D>& centre, double extent) {
  Random random(31);
  for (int s = -1; s < map.scales(); ++s) {  // -1: leaves
    const std::vector<GaussianId> ids = s < 0 ? leaves(map) : gaussiansOfScale(map, s);
    const MapSearch<D> search = s < 0 ? MapSearch<D>(map) : MapSearch<D>(map, s);
    ASSERT_EQ(search.size(), ids.size());
    for (int query = 0; query < 25; ++query) {
      Vector<D> point = centre;
      for (int axis = 0; axis < D; ++axis) point(axis) += extent * (2.0 * random.uniform() - 1.0);
      const List all = allInOrder<D>(map, point, ids);
      for (const int k : {0, 1, 10, 100, 100000}) {
        const std::size_t count = std::min(all.size(), std::size_t(k));
        expectFirst(s < 0 ? nearestLeaves(map, point, k) : nearestK(map, point, k, s), all, count);
        expectFirst(search.nearestK(point, k), all, count);
      }
      if (all.empty()) {
        EXPECT_FALSE(search.nearest(point));
        EXPECT_TRUE(search.within(point, 1e9).empty());
        continue;
      }
      expectFirst({*search.nearest(point)}, all, 1);
      for (const std::size_t about : {0u, 5u, 60u}) {
        const double radius = radiusFor(all, about);
        const std::size_t count = countWithin(all, radius);
        expectFirst(s < 0 ? leavesWithin(map, point, radius) : within(map, point, radius, s), all, count);
        expectFirst(search.within(point, radius), all, count);
      }
    }
  }
}

TEST(MapQueries, FindWhatAComparisonWithAllMeansFinds) {
  const auto map = refine(build<3>(randomCloud<3>(1500, 41), {0.1, 5, 3, 0.0})).map;  // several Gaussians per cell
  expectTheBruteForceResults<3>(map, Vector<3>::Zero(), 3.0);
  expectTheBruteForceResults<3>(map, Vector<3>::Zero(), 300.0);
}
TEST(MapQueries, FindTheSameInAFineTree) {
  expectTheBruteForceResults<3>(build<3>(randomCloud<3>(1500, 42), {0.05, 2, 7, 0.0}), Vector<3>::Zero(), 3.0);
}
TEST(MapQueries, FindTheSameInASingleScale) {
  expectTheBruteForceResults<3>(build<3>(randomCloud<3>(1500, 43), {0.1, 2, 1, 0.0}), Vector<3>::Zero(), 3.0);
}
TEST(MapQueries, FindTheSameInThePlane) {
  expectTheBruteForceResults<2>(build<2>(randomCloud<2>(1500, 44), {0.05, 10, 2, 0.0}), Vector<2>::Zero(), 3.0);
}
TEST(MapQueries, FindTheSameInACompressedMap) {
  const auto map = compress(build<3>(randomCloud<3>(3000, 45), {0.1, 4, 3, 0.0}), 0.3);
  ASSERT_TRUE(map.isCompressed());
  expectTheBruteForceResults<3>(map, Vector<3>::Zero(), 3.0);
}
TEST(MapQueries, FindTheSameFarFromTheOrigin) {
  const Vector<3> far(4e6, -5e6, 100.0);
  std::vector<Vector<3>> points = randomCloud<3>(1000, 46);
  for (Vector<3>& point : points) point += far;
  const auto map = build<3>(points, {0.1, 10, 2, 0.0});
  const Vector<3> query = map.gaussian(17, 0).mean + Vector<3>(0.013, -0.02, 0.007);
  const List all = allInOrder<3>(map, query, leaves<3>(map));
  const List nearby = nearestK<3>(map, query, 20, 0), prepared = MapSearch<3>(map).nearestK(query, 20);
  ASSERT_EQ(nearby.size(), 20u);
  ASSERT_EQ(prepared.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {  // a double resolves a nanometre there
    EXPECT_NEAR(nearby[i].distance, all[i].distance, 1e-8);
    EXPECT_NEAR(prepared[i].distance, all[i].distance, 1e-8);
  }
}

TEST(MapQueries, OfAnEmptyMapFindNothing) {
  const GaussianMapOctree map;
  EXPECT_TRUE(nearestK<3>(map, {0, 0, 0}, 5, 0).empty());
  EXPECT_TRUE(within<3>(map, {0, 0, 0}, 1e6, 2).empty());
  EXPECT_TRUE(nearestLeaves<3>(map, {0, 0, 0}, 5).empty());
  EXPECT_TRUE(leavesWithin<3>(map, {0, 0, 0}, 5).empty());
  EXPECT_EQ(MapSearch<3>(map).size(), 0u);
  EXPECT_FALSE(MapSearch<3>(map).nearest({0, 0, 0}));
}

TEST(MapQueries, GiveTiesToTheSmallerIndexAndIncludeTheBorder) {  // four means, all 0.25 m from the middle
  const auto map =
      build<3>({{0.25, 0.5, 0.5}, {0.75, 0.5, 0.5}, {0.5, 0.25, 0.5}, {0.5, 0.75, 0.5}}, {0.125, 2, 2, 0.0});
  const Vector<3> middle(0.5, 0.5, 0.5);
  for (const List& found : {nearestK<3>(map, middle, 4, 0), within<3>(map, middle, 0.25, 0),
                            MapSearch<3>(map, 0).nearestK(middle, 4), MapSearch<3>(map, 0).within(middle, 0.25)}) {
    ASSERT_EQ(found.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(found[i].id, (GaussianId{0, i}));
  }
  EXPECT_EQ(nearest<3>(map, middle, 0)->index, 0u);
  EXPECT_EQ(MapSearch<3>(map, 0).nearest(middle)->id, (GaussianId{0, 0}));
  EXPECT_TRUE(within<3>(map, middle, 0.2499, 0).empty());
  EXPECT_EQ(within<3>(map, map.gaussian(2, 0).mean, 0.0, 0).size(), 1u);
}

TEST(MapQueries, RefuseWhatTheyCannotSearch) {
  const auto map = build<3>(randomCloud<3>(100, 47), {0.1, 5, 2, 0.0});
  const MapSearch<3> search(map);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector<3>& bad : {Vector<3>(nan, 0, 0), Vector<3>(0, 1e300, 0), Vector<3>(0, 0, -1e9)}) {
    EXPECT_THROW(nearest<3>(map, bad, 0), std::out_of_range);
    EXPECT_THROW(nearestK<3>(map, bad, 3, 0), std::out_of_range);
    EXPECT_THROW(within<3>(map, bad, 3.0, 0), std::out_of_range);
    EXPECT_THROW(nearestLeaves<3>(map, bad, 3), std::out_of_range);
    EXPECT_THROW(search.nearest(bad), std::out_of_range);
    EXPECT_THROW(search.nearestK(bad, 3), std::out_of_range);
    EXPECT_THROW(search.within(bad, 3.0), std::out_of_range);
  }
  const Vector<3> good(0, 0, 0);
  EXPECT_THROW(nearest<3>(map, good, 2), std::out_of_range);
  EXPECT_THROW(nearestK<3>(map, good, 1, -1), std::out_of_range);
  EXPECT_THROW(within<3>(map, good, 1.0, 2), std::out_of_range);
  EXPECT_THROW(MapSearch<3>(map, 2), std::out_of_range);
  EXPECT_THROW(nearestK<3>(map, good, -1, 0), std::invalid_argument);
  EXPECT_THROW(search.nearestK(good, -1), std::invalid_argument);
  EXPECT_THROW(within<3>(map, good, nan, 0), std::invalid_argument);
  EXPECT_THROW(leavesWithin<3>(map, good, -1.0), std::invalid_argument);
  EXPECT_THROW(search.within(good, -0.5), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
