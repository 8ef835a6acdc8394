// SPDX-License-Identifier: BSD-3-Clause
// Uses PCL's class templates with PointGaussian. A source includes it after the headers of PCL and of gaussmap, in the
// order that it tests.
#pragma once

#include <cstddef>
#include <cstdio>
#include <vector>

namespace gaussmap::test {

/// Returns the number of checks that fail, and prints them. Static, so that the linker sees the calls of every source.
static int useTemplatesOfPcl() {
  int failures = 0;
  const auto expect = [&failures](const char* what, std::size_t found, std::size_t expected) {
    if (found == expected) return;
    std::printf("%s: %zu instead of %zu\n", what, found, expected);
    ++failures;
  };
  using Cloud = pcl::PointCloud<PointGaussian>;
  const auto ten = pcl::make_shared<Cloud>();  // Gaussians at x = 0, 1, ... 9
  for (int i = 0; i < 10; ++i) {
    PointGaussian point{};
    point.x = static_cast<float>(i);
    point.data[3] = 1.0f;
    point.weight = 5.0f;
    point.scale = i < 4 ? 0.0f : 1.0f;
    ten->push_back(point);
  }
  Cloud out;
  pcl::Indices indices;
  std::vector<float> squares;

  pcl::PassThrough<PointGaussian> pass;
  pass.setInputCloud(ten);
  pass.setFilterFieldName("scale");
  pass.setFilterLimits(0.5f, 1.5f);
  pass.filter(out);
  expect("PassThrough", out.size(), 6);
  pcl::VoxelGrid<PointGaussian> grid;
  grid.setInputCloud(ten);
  grid.setLeafSize(5.0f, 5.0f, 5.0f);
  grid.filter(out);
  expect("VoxelGrid", out.size(), 2);
  pcl::CropBox<PointGaussian> box;
  box.setInputCloud(ten);
  box.setMin({1.5f, -1.0f, -1.0f, 1.0f});
  box.setMax({3.5f, 1.0f, 1.0f, 1.0f});
  box.filter(out);
  expect("CropBox", out.size(), 2);
  pcl::ExtractIndices<PointGaussian> extract;
  extract.setInputCloud(ten);
  extract.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{1, 5, 7}));
  extract.filter(out);
  expect("ExtractIndices", out.size(), 3);
  pcl::StatisticalOutlierRemoval<PointGaussian> statistics;
  statistics.setInputCloud(ten);
  statistics.setMeanK(2);
  statistics.setStddevMulThresh(10.0);
  statistics.filter(out);
  expect("StatisticalOutlierRemoval", out.size(), 10);
  pcl::RadiusOutlierRemoval<PointGaussian> radius;
  radius.setInputCloud(ten);
  radius.setRadiusSearch(1.5);
  radius.setMinNeighborsInRadius(2);
  radius.filter(out);
  expect("RadiusOutlierRemoval", out.size(), 8);
  pcl::UniformSampling<PointGaussian> uniform;
  uniform.setInputCloud(ten);
  uniform.setRadiusSearch(5.0);
  uniform.filter(out);
  expect("UniformSampling", out.size(), 2);
  pcl::RandomSample<PointGaussian> sample;
  sample.setInputCloud(ten);
  sample.setSample(4);
  sample.filter(out);
  expect("RandomSample", out.size(), 4);
  const auto condition = pcl::make_shared<pcl::ConditionAnd<PointGaussian>>();
  condition->addComparison(pcl::make_shared<pcl::FieldComparison<PointGaussian>>("x", pcl::ComparisonOps::LT, 2.5));
  pcl::ConditionalRemoval<PointGaussian> conditional;
  conditional.setCondition(condition);
  conditional.setInputCloud(ten);
  conditional.filter(out);
  expect("ConditionalRemoval", out.size(), 3);
  pcl::removeNaNFromPointCloud(*ten, out, indices);
  expect("removeNaNFromPointCloud", out.size(), 10);

  const PointGaussian& query = (*ten)[6];
  const auto search = [&](const char* what, auto& tree) {
    tree.nearestKSearch(query, 3, indices, squares);
    expect(what, indices.size(), 3);
    expect(what, indices.empty() ? 99 : std::size_t(indices[0]), 6);
    expect(what, std::size_t(tree.radiusSearch(query, 2.5, indices, squares)), 5);
  };
  pcl::KdTreeFLANN<PointGaussian> flann;
  flann.setInputCloud(ten);
  search("KdTreeFLANN", flann);
  pcl::search::KdTree<PointGaussian> kd_tree;
  kd_tree.setInputCloud(ten);
  search("search::KdTree", kd_tree);
  pcl::search::BruteForce<PointGaussian> brute_force;
  brute_force.setInputCloud(ten);
  search("search::BruteForce", brute_force);
  pcl::search::Octree<PointGaussian> octree_search(0.5);
  octree_search.setInputCloud(ten);
  search("search::Octree", octree_search);
  pcl::octree::OctreePointCloudSearch<PointGaussian> octree(0.5);
  octree.setInputCloud(ten);
  octree.addPointsFromInputCloud();
  search("OctreePointCloudSearch", octree);
  pcl::octree::OctreePointCloudDensity<PointGaussian> density(0.5);
  density.setInputCloud(ten);
  density.addPointsFromInputCloud();
  expect("OctreePointCloudDensity", density.getVoxelDensityAtPoint(query), 1);
  pcl::octree::OctreePointCloudChangeDetector<PointGaussian> changes(0.5);
  changes.setInputCloud(ten);
  changes.addPointsFromInputCloud();
  changes.getPointIndicesFromNewVoxels(indices);
  expect("OctreePointCloudChangeDetector", indices.empty(), false);
  pcl::EuclideanClusterExtraction<PointGaussian> clustering;
  clustering.setInputCloud(ten);
  clustering.setClusterTolerance(1.5);
  std::vector<pcl::PointIndices> clusters;
  clustering.extract(clusters);
  expect("EuclideanClusterExtraction", clusters.size(), 1);
  return failures;
}

}  // namespace gaussmap::test
