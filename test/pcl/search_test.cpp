// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/search.h"

#include <gtest/gtest.h>
#include <pcl/features/normal_3d.h>
#include <pcl/search/brute_force.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/impl/extract_clusters.hpp>  // compiled here, so that the tests need not link it

#include <algorithm>
#include <stdexcept>

#include "gaussmap/editing/compress.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/pcl/conversions.h"
#include "map/random_clouds.h"
#include "pcl/random_surface.h"

namespace gaussmap {
namespace {

using test::kNan;
using Search = pcl::search::Search<pcl::PointXYZ>;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// A result of a search, in any order.
struct Found {
  pcl::Indices indices;
  std::vector<float> squares;
  int count = 0;
};

Found nearestOf(const Search& search, const pcl::PointXYZ& point, int k) {
  Found found;
  found.count = search.nearestKSearch(point, k, found.indices, found.squares);
  return found;
}
Found withinOf(const Search& search, const pcl::PointXYZ& point, double radius, unsigned max_nn = 0) {
  Found found;
  found.count = search.radiusSearch(point, radius, found.indices, found.squares, max_nn);
  return found;
}

Found sorted(Found found) {
  std::vector<std::pair<float, pcl::index_t>> pairs;
  for (std::size_t i = 0; i < found.indices.size(); ++i) pairs.emplace_back(found.squares[i], found.indices[i]);
  std::sort(pairs.begin(), pairs.end());
  for (std::size_t i = 0; i < pairs.size(); ++i) std::tie(found.squares[i], found.indices[i]) = pairs[i];
  return found;
}

void expectEqual(const Found& found, const Found& expected) {
  EXPECT_EQ(found.count, expected.count);
  EXPECT_EQ(found.indices, expected.indices);
  EXPECT_EQ(found.squares, expected.squares);
}

/// Points on a lattice of 1/4 m, some of them equal: float distances between them are exact, and there are many ties.
Cloud::Ptr latticeCloud(std::size_t size) {
  auto cloud = pcl::make_shared<Cloud>();
  Random random(5);
  const auto number = [&] { return 0.25f * static_cast<float>(random.below(24)); };
  for (std::size_t i = 0; i < size; ++i) cloud->emplace_back(number(), number(), 0.25f * number());
  return cloud;
}

/// Compares a search with PCL's comparison with all points.
void expectTheResultsOfBruteForce(const Cloud::ConstPtr& cloud, const pcl::IndicesConstPtr& indices = nullptr) {
  GaussianMapSearch<pcl::PointXYZ> ours;
  pcl::search::BruteForce<pcl::PointXYZ> all(true);
  ours.setInputCloud(cloud, indices);
  all.setInputCloud(cloud, indices);
  EXPECT_EQ(ours.getInputCloud(), cloud);
  EXPECT_EQ(ours.getIndices(), indices);
  Random random(6);
  for (int query = 0; query < 100; ++query) {
    pcl::PointXYZ point((*cloud)[random.below(cloud->size())]);
    if (query % 2 == 0 || !pcl::isFinite(point))
      point = {0.25f * float(random.below(30)), 0.125f * float(random.below(50)), 0.5f};
    for (const double radius : {0.25, 0.8, 100.0})
      expectEqual(withinOf(ours, point, radius), sorted(withinOf(all, point, radius)));
    const Found complete = sorted(withinOf(all, point, 1000.0));  // by distance, then by index
    for (const int k : {1, 10, 60, 100000}) {
      Found expected = complete;
      expected.count = std::min(k, complete.count);
      expected.indices.resize(std::size_t(expected.count));
      expected.squares.resize(std::size_t(expected.count));
      expectEqual(nearestOf(ours, point, k), expected);
      EXPECT_EQ(nearestOf(all, point, k).squares, expected.squares);
      expectEqual(withinOf(ours, point, 1000.0, unsigned(k)), expected);  // the nearest ones
    }
  }
}

TEST(GaussianMapSearch, FindsWhatBruteForceFinds) {
  expectTheResultsOfBruteForce(latticeCloud(1));
  expectTheResultsOfBruteForce(latticeCloud(700));
}

TEST(GaussianMapSearch, FindsOnlyThePointsOfTheIndices) {
  const auto indices = pcl::make_shared<pcl::Indices>();
  for (int i = 690; i > 0; i -= 3) indices->push_back(i);
  expectTheResultsOfBruteForce(latticeCloud(700), indices);
}

TEST(GaussianMapSearch, LeavesOutPointsThatAreNotFinite) {
  const auto cloud = latticeCloud(700);
  for (std::size_t i = 0; i < cloud->size(); i += 5) (*cloud)[i].x = kNan;
  (*cloud)[3].x = std::numeric_limits<float>::infinity();
  cloud->is_dense = false;
  expectTheResultsOfBruteForce(cloud);
}

TEST(GaussianMapSearch, FindsTheDistancesOfPclsKdTreeInEveryBit) {
  const auto cloud = pcl::make_shared<Cloud>(*test::wavyFloor<pcl::PointXYZ>());
  GaussianMapSearch<pcl::PointXYZ> ours;
  pcl::search::KdTree<pcl::PointXYZ> tree;
  ours.setInputCloud(cloud);
  tree.setInputCloud(cloud);
  Random random(8);
  for (int query = 0; query < 300; ++query) {
    const pcl::PointXYZ point(float(5 * random.uniform()), float(4 * random.uniform()), float(random.uniform()));
    for (const int k : {1, 12}) {
      const Found found = nearestOf(ours, point, k), expected = nearestOf(tree, point, k);
      EXPECT_EQ(found.squares, expected.squares);
      EXPECT_EQ(found.indices, expected.indices);
    }
    expectEqual(withinOf(ours, point, 0.4), sorted(withinOf(tree, point, 0.4)));
    expectEqual(withinOf(ours, point, 0.4, 5), sorted(withinOf(tree, point, 0.4, 5)));
  }
}

TEST(GaussianMapSearch, TakesAPointByItsIndexAndManyPoints) {
  const auto cloud = latticeCloud(200);
  const auto indices = pcl::make_shared<pcl::Indices>(pcl::Indices{7, 3, 150, 20});
  GaussianMapSearch<pcl::PointXYZ> search;
  search.setInputCloud(cloud, indices);
  Found by_index, expected = nearestOf(search, (*cloud)[150], 3);
  by_index.count = search.nearestKSearch(2, 3, by_index.indices, by_index.squares);  // indices[2]
  expectEqual(by_index, expected);
  std::vector<pcl::Indices> all_indices;
  std::vector<std::vector<float>> all_squares;
  search.nearestKSearch(*cloud, pcl::Indices{1, 150}, 3, all_indices, all_squares);
  ASSERT_EQ(all_indices.size(), 2u);
  EXPECT_EQ(all_indices[1], expected.indices);
  search.radiusSearch(*cloud, pcl::Indices(), 1.0, all_indices, all_squares);
  ASSERT_EQ(all_indices.size(), 200u);
  EXPECT_EQ(all_indices[3], withinOf(search, (*cloud)[3], 1.0).indices);
}

TEST(GaussianMapSearch, OfABadQueryFindsNothing) {
  GaussianMapSearch<pcl::PointXYZ> search;
  const auto expectNothing = [](const Found& found) {
    EXPECT_EQ(found.count, 0);
    EXPECT_TRUE(found.indices.empty());
    EXPECT_TRUE(found.squares.empty());
  };
  const pcl::PointXYZ origin(0, 0, 0), bad(0, kNan, 0);
  expectNothing(nearestOf(search, origin, 5));  // no cloud
  expectNothing(withinOf(search, origin, 5.0));
  search.setInputCloud(pcl::make_shared<Cloud>());
  expectNothing(nearestOf(search, origin, 5));
  search.setInputCloud(latticeCloud(50));
  expectNothing(nearestOf(search, bad, 5));
  expectNothing(withinOf(search, bad, 5.0));
  expectNothing(nearestOf(search, origin, 0));
  expectNothing(nearestOf(search, origin, -1));
  for (const double radius : {0.0, -1.0, double(kNan)}) expectNothing(withinOf(search, origin, radius));
  Found used{{1, 2, 3}, {1.0f, 2.0f, 3.0f}, 3};
  used.count = search.radiusSearch(pcl::PointXYZ(100, 100, 100), 1.0, used.indices, used.squares);
  expectNothing(used);
  search.setInputCloud(nullptr);  // an error message
  expectNothing(nearestOf(search, origin, 5));
}

TEST(GaussianMapSearch, ReturnsUnsortedNeighboursOnRequest) {
  GaussianMapSearch<pcl::PointXYZ> search(false);
  EXPECT_FALSE(search.getSortedResults());
  EXPECT_TRUE(GaussianMapSearch<pcl::PointXYZ>().getSortedResults());
  EXPECT_EQ(search.getName(), "GaussianMapSearch");
  const auto cloud = latticeCloud(700);
  search.setInputCloud(cloud);
  const Found loose = withinOf(search, (*cloud)[9], 3.0);
  EXPECT_FALSE(std::is_sorted(loose.squares.begin(), loose.squares.end()));
  search.setSortedResults(true);
  expectEqual(withinOf(search, (*cloud)[9], 3.0), sorted(loose));
}

TEST(GaussianMapSearch, GivesNormalEstimationTheNormalsOfPclsKdTree) {
  const auto cloud = test::wavyFloor<pcl::PointXYZ>();  // organised
  pcl::PointCloud<pcl::Normal> normals[2];
  for (int i = 0; i < 2; ++i) {
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud);
    estimation.setKSearch(12);
    if (i == 0)
      estimation.setSearchMethod(pcl::make_shared<GaussianMapSearch<pcl::PointXYZ>>());
    else
      estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.compute(normals[i]);
  }
  ASSERT_EQ(normals[0].size(), cloud->size());
  EXPECT_EQ(normals[0].height, cloud->height);
  for (std::size_t i = 0; i < cloud->size(); ++i)
    ASSERT_EQ(normals[0][i].getNormalVector3fMap(), normals[1][i].getNormalVector3fMap()) << i;
}

TEST(GaussianMapSearch, GivesEuclideanClusterExtractionTheClustersOfPclsKdTree) {
  auto cloud = pcl::make_shared<Cloud>();
  for (const auto& p : test::randomCloud<3>(3000, 9)) cloud->emplace_back(float(p.x()), float(p.y()), float(p.z()));
  std::vector<pcl::PointIndices> clusters[2];
  for (int i = 0; i < 2; ++i) {
    pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
    extraction.setInputCloud(cloud);
    extraction.setClusterTolerance(0.1);
    if (i == 0)
      extraction.setSearchMethod(pcl::make_shared<GaussianMapSearch<pcl::PointXYZ>>());
    else
      extraction.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    extraction.extract(clusters[i]);
  }
  ASSERT_GT(clusters[0].size(), 5u);
  ASSERT_EQ(clusters[0].size(), clusters[1].size());
  for (std::size_t i = 0; i < clusters[0].size(); ++i)
    EXPECT_EQ(clusters[0][i].indices.size(), clusters[1][i].indices.size());
}

TEST(GaussianMapSearch, OfAMapFindsItsMeans) {
  const auto map = build<3>(test::randomCloud<3>(2000, 10), {0.1, 5, 3, 0.0});
  GaussianMapSearch<PointGaussian> search;
  for (int scale = 0; scale < 3; ++scale) {
    search.setInputMap(map, scale);
    const auto expected = toPointCloud(map, scale);
    ASSERT_EQ(search.getInputCloud()->size(), expected.size());
    EXPECT_EQ(search.getGaussians(), gaussiansOfScale(map, scale));
    for (std::size_t i = 0; i < expected.size(); i += 7) {
      const PointGaussian& point = (*search.getInputCloud())[i];
      EXPECT_EQ(point.getVector3fMap(), expected[i].getVector3fMap());
      EXPECT_EQ(point.weight, expected[i].weight);
      pcl::Indices indices;
      std::vector<float> squares;
      ASSERT_EQ(search.nearestKSearch(point, 4, indices, squares), std::min<int>(4, int(expected.size())));
      EXPECT_EQ(std::size_t(indices[0]), i);
      const Vector<3> mean = point.getVector3fMap().cast<double>();
      const auto same = nearestK<3>(map, mean, 4, scale);
      for (std::size_t n = 0; n < indices.size(); ++n)
        EXPECT_NEAR(std::sqrt(squares[n]), same[n].distance, 1e-6 * (1.0 + same[n].distance));
    }
  }
  EXPECT_THROW(search.setInputMap(map, 3), std::out_of_range);
  search.setInputCloud(pcl::make_shared<pcl::PointCloud<PointGaussian>>());
  EXPECT_TRUE(search.getGaussians().empty());
}

TEST(GaussianMapSearch, OfACompressedMapFindsItsLeaves) {
  const auto map = compress(build<3>(test::randomCloud<3>(3000, 45), {0.1, 4, 3, 0.0}), 0.3);
  ASSERT_TRUE(map.isCompressed());
  GaussianMapSearch<pcl::PointXYZ> search;
  search.setInputMap(map);
  EXPECT_EQ(search.getGaussians(), leaves(map));
  EXPECT_EQ(search.getInputCloud()->size(), leaves(map).size());
  const Found found = nearestOf(search, {0.1f, 0.2f, 0.3f}, 5);
  const auto expected = nearestLeaves<3>(map, Vector<3>(double{0.1f}, double{0.2f}, double{0.3f}), 5);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(search.getGaussians()[std::size_t(found.indices[i])], expected[i].id);
}

TEST(GaussianMapSearch, OfAMapFarFromTheOriginIsRelativeToTheSensorOrigin) {
  std::vector<Vector<3>> points = test::randomCloud<3>(500, 11);
  for (Vector<3>& point : points) point += Vector<3>(4e6, -5e6, 0.0);
  const auto map = build<3>(points, {0.1, 10, 2, 0.0});
  GaussianMapSearch<PointGaussian> search;
  search.setInputMap(map, 0);
  const auto expected = toPointCloud(map, 0);
  EXPECT_EQ(search.getInputCloud()->sensor_origin_, expected.sensor_origin_);
  EXPECT_GT(expected.sensor_origin_.norm(), 1e6f);
  pcl::Indices indices;
  std::vector<float> squares;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(search.nearestKSearch(expected[i], 1, indices, squares), 1);
    EXPECT_EQ(std::size_t(indices[0]), i);
    EXPECT_EQ(squares[0], 0.0f);
  }
}

}  // namespace
}  // namespace gaussmap
