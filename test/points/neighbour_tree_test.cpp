// SPDX-License-Identifier: BSD-3-Clause
#include "points/neighbour_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "points/nearest_list.h"

namespace gaussmap::detail {
namespace {

template <typename Scalar>
using Points = std::vector<typename NeighbourTree<Scalar>::Point>;
template <typename Scalar>
using Found = std::vector<Neighbour<Scalar, std::uint32_t>>;

template <typename Scalar>
constexpr Scalar kFar = std::numeric_limits<Scalar>::infinity();

/// Returns all points by distance, then by index.
template <typename Scalar>
Found<Scalar> inOrder(const Points<Scalar>& points, const std::array<Scalar, 3>& query) {
  Found<Scalar> all;
  for (const auto& point : points) {
    const Scalar x = query[0] - point.at[0], y = query[1] - point.at[1], z = query[2] - point.at[2];
    all.push_back({x * x + y * y + z * z, point.index});
  }
  std::sort(all.begin(), all.end());
  return all;
}

template <typename Scalar>
void expectEqual(const Found<Scalar>& found, const Found<Scalar>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].distance, expected[i].distance) << i;
    ASSERT_EQ(found[i].index, expected[i].index) << i;
  }
}

/// Compares all kinds of searches with a comparison with all points, in every bit.
template <typename Scalar>
void expectTheBruteForceResults(const Points<Scalar>& points, const std::vector<std::array<Scalar, 3>>& queries) {
  const NeighbourTree<Scalar> tree(points);
  ASSERT_EQ(tree.size(), points.size());
  for (const auto& query : queries) {
    const Found<Scalar> all = inOrder<Scalar>(points, query);
    NearestOne<Scalar, std::uint32_t> one(kFar<Scalar>);
    tree.search(query, one);
    expectEqual<Scalar>({one.best()}, {all[0]});
    for (const std::size_t k : {std::size_t{1}, std::size_t{7}, std::size_t{50}, points.size() + 3}) {
      NearestList<Scalar, std::uint32_t> list(k, kFar<Scalar>);
      tree.search(query, list);
      expectEqual<Scalar>(list.sort(),
                          Found<Scalar>(all.begin(), all.begin() + std::ptrdiff_t(std::min(k, all.size()))));
    }
    const Scalar limit = all[std::min<std::size_t>(20, all.size() - 1)].distance;  // of a point on the border
    const auto inside = [&](const auto& entry) { return entry.distance <= limit; };
    NeighboursWithin<Scalar, std::uint32_t> within(limit);
    tree.search(query, within);
    expectEqual<Scalar>(within.sort(),
                        Found<Scalar>(all.begin(), std::partition_point(all.begin(), all.end(), inside)));
  }
}

template <typename Scalar>
class NeighbourTreeTest : public testing::Test {
 protected:
  Scalar number(double scale) { return static_cast<Scalar>(scale * (2.0 * random_.uniform() - 1.0)); }
  std::array<Scalar, 3> place(double x, double y, double z) { return {number(x), number(y), number(z)}; }

  Random random_{7};
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(NeighbourTreeTest, Scalars, );

TYPED_TEST(NeighbourTreeTest, FindsWhatAComparisonWithAllPointsFinds) {
  for (const double height : {10.0, 0.01, 0.0}) {  // a volume, a surface, a plane
    for (const std::size_t size : {1u, 2u, 24u, 25u, 300u, 3000u}) {
      Points<TypeParam> points;
      for (std::size_t i = 0; i < size; ++i)
        points.push_back({this->place(10, 10, height), static_cast<std::uint32_t>(3 * i + 1)});
      std::vector<std::array<TypeParam, 3>> queries;
      for (int i = 0; i < 30; ++i) queries.push_back(this->place(12, 12, 12));
      for (int i = 0; i < 30; ++i) queries.push_back(points[this->random_.below(size)].at);
      queries.push_back(this->place(1e6, 1e6, 1e6));
      expectTheBruteForceResults<TypeParam>(points, queries);
    }
  }
}

TYPED_TEST(NeighbourTreeTest, GivesTiesToTheSmallerIndex) {
  Points<TypeParam> lattice;  // in shuffled order: many equal distances
  for (int x = 0; x < 9; ++x)
    for (int y = 0; y < 9; ++y)
      for (int z = 0; z < 9; ++z) lattice.push_back({{TypeParam(x), TypeParam(y), TypeParam(z)}, 0});
  for (std::size_t i = 0; i < lattice.size(); ++i) std::swap(lattice[i], lattice[this->random_.below(lattice.size())]);
  for (std::size_t i = 0; i < lattice.size(); ++i) lattice[i].index = static_cast<std::uint32_t>(i);
  std::vector<std::array<TypeParam, 3>> queries;
  for (int i = 0; i < 60; ++i)
    queries.push_back({TypeParam(0.5) * TypeParam(this->random_.below(18)),
                       TypeParam(0.5) * TypeParam(this->random_.below(18)), TypeParam(4)});
  expectTheBruteForceResults<TypeParam>(lattice, queries);
}

TYPED_TEST(NeighbourTreeTest, FindsEqualPointsInTheOrderOfTheirIndices) {
  Points<TypeParam> points;
  for (std::uint32_t i = 0; i < 500; ++i) points.push_back({{1, 2, 3}, 1000 - i});
  for (std::uint32_t i = 0; i < 100; ++i) points.push_back({this->place(3, 3, 3), i});
  expectTheBruteForceResults<TypeParam>(points, {{1, 2, 3}, {0, 0, 0}, {1, 2, TypeParam(3.01)}});
}

TYPED_TEST(NeighbourTreeTest, SeparatesPointsThatAreMuchCloserThanTheirFarthestPoint) {
  Points<TypeParam> points;
  for (std::uint32_t i = 0; i < 400; ++i) points.push_back({this->place(1e-5, 1e-5, 1e-5), i});
  points.push_back({{TypeParam(1e7), 0, 0}, 400});
  points.push_back({{TypeParam(1e15), 0, 0}, 401});
  std::vector<std::array<TypeParam, 3>> queries = {{TypeParam(1e7), 1, 0}, {TypeParam(9e14), 1, 0}};
  for (int i = 0; i < 20; ++i) queries.push_back(this->place(1e-5, 1e-5, 1e-5));
  expectTheBruteForceResults<TypeParam>(points, queries);
}

TYPED_TEST(NeighbourTreeTest, SearchesWithManyOpenNodes) {
  Points<TypeParam> points;  // distances grow by a factor: the tree is as deep as it can be
  TypeParam at = TypeParam(1e-30);
  for (std::uint32_t i = 0; i < 3000; ++i, at *= TypeParam(1.05)) points.push_back({{at, at, 0}, i});
  expectTheBruteForceResults<TypeParam>(points, {{0, 0, 0}, {1, 1, 1}, {TypeParam(1e-8), 0, 0}});
}

TYPED_TEST(NeighbourTreeTest, OfNoPointsFindsNothing) {
  NeighboursWithin<TypeParam, std::uint32_t> within(kFar<TypeParam>);
  NeighbourTree<TypeParam>().search({0, 0, 0}, within);
  NeighbourTree<TypeParam>(Points<TypeParam>()).search({0, 0, 0}, within);
  EXPECT_TRUE(within.entries().empty());
}

}  // namespace
}  // namespace gaussmap::detail
