// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/gaussian_map_filter.h"

#include <gtest/gtest.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/filters/voxel_grid.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include "pcl/random_surface.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::makeNan;
using test::wavyFloor;

template <typename PointT>
std::vector<Vector<3>> positions(const pcl::PointCloud<PointT>& cloud) {
  std::vector<Vector<3>> points;
  for (const PointT& point : cloud) points.push_back(point.getVector3fMap().template cast<double>());
  return points;
}

template <typename PointT>
pcl::PointCloud<PointT> filtered(GaussianMapFilter<PointT>& filter,
                                 const typename pcl::PointCloud<PointT>::ConstPtr& cloud) {
  pcl::PointCloud<PointT> output;
  filter.setInputCloud(cloud);
  filter.filter(output);
  return output;
}

TEST(GaussianMapFilter, IsNearerToTheInputThanPclsFiltersWithAsManyPoints) {
  auto cloud = wavyFloor<pcl::PointXYZ>(200, 150);
  Random random(3);
  for (auto& point : *cloud) {  // not on a lattice, and no layer of cells is parallel to the floor
    point.x = 20.0f * static_cast<float>(random.uniform());
    point.y = 15.0f * static_cast<float>(random.uniform());
    point.z = 0.4f * point.x + 0.2f * point.y + 0.3f * std::sin(point.x);
  }
  const auto errors = [&](const pcl::PointCloud<pcl::PointXYZ>& kept) {
    std::vector<double> distances = nearestDistances(positions(*cloud), positions(kept));
    std::sort(distances.begin(), distances.end());
    return std::pair(distances[distances.size() * 95 / 100],
                     std::accumulate(distances.begin(), distances.end(), 0.0) / double(distances.size()));
  };
  for (const float leaf : {0.5f, 1.5f}) {
    pcl::PointCloud<pcl::PointXYZ> voxels, uniform;
    pcl::VoxelGrid<pcl::PointXYZ> voxel_grid;
    voxel_grid.setLeafSize(leaf, leaf, leaf);
    voxel_grid.setInputCloud(cloud);
    voxel_grid.filter(voxels);
    pcl::UniformSampling<pcl::PointXYZ> sampling;
    sampling.setRadiusSearch(double(leaf));
    sampling.setInputCloud(cloud);
    sampling.filter(uniform);
    for (const FilterOutput output : {FilterOutput::Means, FilterOutput::Samples}) {
      const auto& peer = output == FilterOutput::Means ? voxels : uniform;
      GaussianMapFilter<pcl::PointXYZ> filter;
      filter.setBudget(peer.size());
      filter.setOutput(output);
      const auto kept = filtered<pcl::PointXYZ>(filter, cloud);
      EXPECT_LE(kept.size(), peer.size());
      EXPECT_LT(errors(kept).first, errors(peer).first);
      EXPECT_LT(errors(kept).second, errors(peer).second);
    }
  }
}

TEST(GaussianMapFilter, CarriesHeaderAndSensorAsPclsFilters) {
  const auto cloud = wavyFloor<pcl::PointXYZI>();
  pcl::PointCloud<pcl::PointXYZI> voxels;
  pcl::VoxelGrid<pcl::PointXYZI> voxel_grid;
  voxel_grid.setLeafSize(1, 1, 1);
  voxel_grid.setInputCloud(cloud);
  voxel_grid.filter(voxels);
  GaussianMapFilter<pcl::PointXYZI> filter;
  filter.setBudget(50);
  auto kept = filtered<pcl::PointXYZI>(filter, cloud);
  for (const auto* output : {&voxels, &kept}) {
    EXPECT_EQ(output->header.frame_id, "floor");
    EXPECT_EQ(output->header.stamp, 77u);
    EXPECT_EQ(output->sensor_origin_, cloud->sensor_origin_);
    EXPECT_EQ(output->height, 1u);
    EXPECT_EQ(output->width, output->size());
    EXPECT_TRUE(output->is_dense);
  }
  filter.filter(*cloud);  // into its own input
  EXPECT_EQ(cloud->size(), kept.size());
}

TEST(GaussianMapFilter, AveragesTheOtherFieldsAsPclDoes) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZRGB>>();
  auto intensities = pcl::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
  for (const int i : {0, 1, 2}) {
    pcl::PointXYZRGB point(float(i), 0, 0, std::uint8_t(10 * i), std::uint8_t(100 + i), 7);
    cloud->push_back(point);
    pcl::PointXYZI intensity;
    intensity.x = float(i);
    intensity.y = intensity.z = 0;
    intensity.intensity = i == 1 ? test::kNan : float(i);
    intensities->push_back(intensity);
  }
  GaussianMapFilter<pcl::PointXYZRGB> filter;
  filter.setBudget(1);
  const auto one = filtered<pcl::PointXYZRGB>(filter, cloud);
  pcl::VoxelGrid<pcl::PointXYZRGB> voxel_grid;
  voxel_grid.setLeafSize(10, 10, 10);
  voxel_grid.setInputCloud(cloud);
  pcl::PointCloud<pcl::PointXYZRGB> voxel;
  voxel_grid.filter(voxel);
  ASSERT_EQ(one.size(), 1u);
  ASSERT_EQ(voxel.size(), 1u);
  EXPECT_EQ(one[0].getVector3fMap(), voxel[0].getVector3fMap());
  EXPECT_EQ(one[0].rgba, voxel[0].rgba);
  EXPECT_EQ(int(one[0].r), 10);
  EXPECT_EQ(int(one[0].g), 101);

  GaussianMapFilter<pcl::PointXYZI> intensity_filter;
  intensity_filter.setBudget(1);
  EXPECT_EQ(filtered<pcl::PointXYZI>(intensity_filter, intensities)[0].intensity, 1.0f);  // NaN does not count
}

TEST(GaussianMapFilter, FillsNormalsThatAreMissingAndAveragesThoseThatAreNot) {
  auto cloud = wavyFloor<pcl::PointNormal>();
  for (auto& point : *cloud) point.normal_x = point.normal_y = point.normal_z = 0.0f;
  GaussianMapFilter<pcl::PointNormal> filter;
  filter.setBudget(100);
  for (const FilterOutput output : {FilterOutput::Means, FilterOutput::Samples}) {
    filter.setOutput(output);
    for (const pcl::PointNormal& point : filtered<pcl::PointNormal>(filter, cloud)) {
      const Eigen::Vector3f expected = Eigen::Vector3f(-0.6f * std::cos(3 * point.x), 0, 1).normalized();
      EXPECT_GT(point.getNormalVector3fMap().dot(expected), 0.95f);
      EXPECT_NEAR(point.getNormalVector3fMap().norm(), 1.0f, 1e-5f);
      EXPECT_GE(point.curvature, 0.0f);
    }
  }
  filter.setOutput(FilterOutput::Means);
  for (auto& point : *cloud) point.normal_x = 1.0f;
  for (const pcl::PointNormal& point : filtered<pcl::PointNormal>(filter, cloud))
    EXPECT_EQ(point.getNormalVector3fMap(), Eigen::Vector3f::UnitX());
}

TEST(GaussianMapFilter, OfSamplesKeepsPointsOfTheInputAsTheyAre) {
  auto cloud = wavyFloor<pcl::PointXYZI>();
  for (std::size_t i = 0; i < cloud->size(); ++i) (*cloud)[i].intensity = float(i);
  GaussianMapFilter<pcl::PointXYZI> filter(true);
  filter.setBudget(100);
  filter.setOutput(FilterOutput::Samples);
  const auto kept = filtered<pcl::PointXYZI>(filter, cloud);
  std::vector<bool> is_kept(cloud->size(), false);
  for (const pcl::PointXYZI& point : kept) {
    const auto i = std::size_t(point.intensity);
    EXPECT_EQ(point.getVector3fMap(), (*cloud)[i].getVector3fMap());
    is_kept[i] = true;
  }
  EXPECT_EQ(filter.getRemovedIndices()->size() + kept.size(), cloud->size());
  for (const auto i : *filter.getRemovedIndices()) EXPECT_FALSE(is_kept[std::size_t(i)]);
}

TEST(GaussianMapFilter, TellsWhichKeptPointStandsForWhich) {
  const auto cloud = wavyFloor<pcl::PointXYZ>();
  GaussianMapFilter<pcl::PointXYZ> filter;
  filter.setMaxError(0.3);
  const auto kept = filtered<pcl::PointXYZ>(filter, cloud);
  EXPECT_LE(filter.error(), 0.3);
  ASSERT_EQ(filter.getLabels().size(), cloud->size());
  ASSERT_EQ(filter.getGaussians().size(), kept.size());
  double weight = 0.0;
  for (const Gaussian<3>& gaussian : filter.getGaussians()) weight += gaussian.weight;
  EXPECT_EQ(weight, double(cloud->size()));
  std::size_t within = 0;
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    const auto& point = kept[std::size_t(filter.getLabels()[i])];
    within += ((*cloud)[i].getVector3fMap() - point.getVector3fMap()).norm() <= 0.3f + 1e-5f;
  }
  EXPECT_GE(double(within), 0.95 * double(cloud->size()));
}

TEST(GaussianMapFilter, TakesTheSameIndicesAndLeavesOutNanAsVoxelGrid) {
  auto cloud = wavyFloor<pcl::PointXYZ>();
  makeNan((*cloud)[5]);
  cloud->is_dense = false;
  const auto indices = pcl::make_shared<pcl::Indices>();
  for (int i = 0; i < 200; ++i) indices->push_back(i);
  pcl::PointCloud<pcl::PointXYZ> voxel;
  pcl::VoxelGrid<pcl::PointXYZ> voxel_grid;
  voxel_grid.setLeafSize(100, 100, 100);
  voxel_grid.setInputCloud(cloud);
  voxel_grid.setIndices(indices);
  voxel_grid.filter(voxel);
  GaussianMapFilter<pcl::PointXYZ> filter(true);
  filter.setBudget(1);
  filter.setIndices(indices);
  const auto one = filtered<pcl::PointXYZ>(filter, cloud);
  // VoxelGrid cuts at the origin: the heights of the floor fall into two cells.
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (int i = 0; i < 200; ++i)
    if (i != 5) mean += (*cloud)[std::size_t(i)].getVector3fMap() / 199.0f;
  ASSERT_EQ(one.size(), 1u);
  EXPECT_LT((one[0].getVector3fMap() - mean).norm(), 1e-4f);
  EXPECT_TRUE(one.is_dense);
  EXPECT_EQ(filter.getRemovedIndices()->size(), 199u);
  EXPECT_EQ(filter.getRemovedIndices()->front(), 5);
  EXPECT_EQ(filter.getLabels()[5], -1);
  EXPECT_EQ(filter.getLabels()[300], -1);
  for (const auto& point : voxel) EXPECT_TRUE(point.getVector3fMap().allFinite());
}

TEST(GaussianMapFilter, GivesNothingForNothingAndOneForOneOrEqualPoints) {
  GaussianMapFilter<pcl::PointNormal> filter;
  pcl::PointCloud<pcl::PointNormal> output(3, 1);
  filter.filter(output);  // no cloud: as pcl::VoxelGrid, nothing happens
  EXPECT_EQ(output.size(), 3u);
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  EXPECT_TRUE(filtered<pcl::PointNormal>(filter, cloud).empty());
  cloud->push_back(pcl::PointNormal(1, 2, 3));
  EXPECT_EQ(filtered<pcl::PointNormal>(filter, cloud).size(), 1u);
  cloud->assign(50, pcl::PointNormal(1, 2, 3));
  const auto one = filtered<pcl::PointNormal>(filter, cloud);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].getVector3fMap(), Eigen::Vector3f(1, 2, 3));
  EXPECT_TRUE(std::isnan(one[0].normal_x));
  for (auto& point : *cloud) makeNan(point);
  EXPECT_TRUE(filtered<pcl::PointNormal>(filter, cloud).empty());
}

TEST(GaussianMapFilter, TakesFarClouds) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < 400; ++i) cloud->emplace_back(1e7f + float(i % 20), -1e7f + float(i / 20), 1e7f);
  GaussianMapFilter<pcl::PointXYZ> filter;
  filter.setMaxError(3.0);
  const auto kept = filtered<pcl::PointXYZ>(filter, cloud);
  EXPECT_GT(kept.size(), 5u);
  EXPECT_LT(kept.size(), 60u);
  for (const auto& point : kept) EXPECT_EQ(point.z, 1e7f);
}

TEST(GaussianMapFilter, PrintsAnErrorForOptionsThatAreNone) {
  GaussianMapFilter<pcl::PointXYZ> filter;
  filter.setBudget(0);
  EXPECT_TRUE(filtered<pcl::PointXYZ>(filter, wavyFloor<pcl::PointXYZ>()).empty());
}

TEST(GaussianMapFilter, KeepsAnErrorThatNeedsMorePointsThanTheDefaultBudget) {
  const auto cloud = wavyFloor<pcl::PointXYZ>(200, 150);
  for (const FilterMethod method : {FilterMethod::Map, FilterMethod::Split}) {
    GaussianMapFilter<pcl::PointXYZ> filter;
    filter.setMethod(method);
    filter.setMaxError(0.05);
    testing::internal::CaptureStderr();
    const auto kept = filtered<pcl::PointXYZ>(filter, cloud);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_GT(kept.size(), 10000u);
    EXPECT_LE(filter.error(), 0.05);
    filter.setBudget(500);  // now this limit wins, and the filter says so
    testing::internal::CaptureStderr();
    EXPECT_EQ(filtered<pcl::PointXYZ>(filter, cloud).size(), 500u);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("raise the budget"), std::string::npos);
    EXPECT_GT(filter.error(), 0.05);
  }
}

TEST(GaussianMapFilter, OfALeafSizeKeepsTheCentroidsOfVoxelGrid) {
  const auto cloud = wavyFloor<pcl::PointXYZ>(200, 150);
  for (const int scale : {0, 2}) {
    const float leaf = 0.3f * static_cast<float>(1 << scale);
    pcl::VoxelGrid<pcl::PointXYZ> voxel_grid;
    voxel_grid.setLeafSize(leaf, leaf, leaf);
    voxel_grid.setInputCloud(cloud);
    pcl::PointCloud<pcl::PointXYZ> voxels;
    voxel_grid.filter(voxels);
    GaussianMapFilter<pcl::PointXYZ> filter;
    filter.setLeafSize(double(leaf) / (1 << scale));
    filter.setScale(scale);
    const auto kept = filtered<pcl::PointXYZ>(filter, cloud);
    ASSERT_EQ(kept.size(), voxels.size());
    for (const double distance : nearestDistances(positions(voxels), positions(kept))) EXPECT_LT(distance, 1e-4);
  }
}

TEST(GaussianMapFilter, GivesTheMapWhoseGaussiansItKeeps) {
  const auto cloud = wavyFloor<pcl::PointXYZ>(200, 150);  // all coordinates but z are positive
  for (auto& point : *cloud) point.z += 5.0f;
  GaussianMapFilter<pcl::PointXYZ> filter;
  EXPECT_TRUE(filter.getMap().empty());
  filter.setBudget(300);
  const auto kept = filtered<pcl::PointXYZ>(filter, cloud);
  const GaussianMapOctree map = filter.getMap();
  EXPECT_EQ(map.weight(0), double(cloud->size()));
  EXPECT_EQ(map.weight(1), double(cloud->size()));
  ASSERT_EQ(map.cellCount(1), 1u);
  ASSERT_EQ(map.gaussianCount(1), kept.size());
  std::vector<Vector<3>> means;
  for (std::size_t i = 0; i < kept.size(); ++i) means.push_back(map.gaussian(i, 1).mean);
  for (const double distance : nearestDistances(means, positions(kept))) EXPECT_LT(distance, 1e-5);
  filter.setMethod(FilterMethod::Split);
  filtered<pcl::PointXYZ>(filter, cloud);
  EXPECT_TRUE(filter.getMap().empty());
}

TEST(GaussianMapFilter, SplitsAsSplitPointsIfAskedTo) {
  const auto cloud = wavyFloor<pcl::PointXYZ>();
  for (const SplitRule rule : {SplitRule::Distance, SplitRule::Shape}) {
    SplitPointsOptions options;
    options.max_parts = 60;
    options.rule = rule;
    const PointParts parts = splitPoints(positions(*cloud), options);
    GaussianMapFilter<pcl::PointXYZ> filter;
    filter.setBudget(60);
    filter.setDetail(rule);  // selects the method, too
    const auto kept = filtered<pcl::PointXYZ>(filter, cloud);
    EXPECT_EQ(filter.options().method, FilterMethod::Split);
    ASSERT_EQ(kept.size(), parts.gaussians.size());
    for (std::size_t i = 0; i < kept.size(); ++i)
      EXPECT_EQ(kept[i].getVector3fMap(), parts.gaussians[i].mean.cast<float>());
    EXPECT_EQ(filter.error(), parts.error);
  }
}

TEST(GaussianMapFilter, GivesTheSamePointsOnAnyNumberOfThreads) {
  const auto cloud = wavyFloor<pcl::PointNormal>(200, 150);
  for (auto& point : *cloud) point.normal_x = point.normal_y = point.normal_z = 0.0f;
  pcl::PointCloud<pcl::PointNormal> first;
  for (const int threads : {1, 2, 5}) {
    GaussianMapFilter<pcl::PointNormal> filter;
    filter.setBudget(200);
    filter.setNumberOfThreads(threads);
    const auto kept = filtered<pcl::PointNormal>(filter, cloud);
    if (first.empty()) first = kept;
    ASSERT_EQ(kept.size(), first.size());
    EXPECT_EQ(std::memcmp(kept.points.data(), first.points.data(), kept.size() * sizeof kept[0]), 0);
  }
}

TEST(GaussianMapFilter, TakesAUsersOwnPointType) {
  auto cloud = wavyFloor<RingPoint>();
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    (*cloud)[i].echo = float(i % 2);
    (*cloud)[i].ring = 300;
  }
  GaussianMapFilter<RingPoint> filter;
  filter.setBudget(10);
  const auto kept = filtered<RingPoint>(filter, cloud);
  ASSERT_GE(kept.size(), 9u);
  for (const RingPoint& point : kept) {
    EXPECT_NEAR(point.echo, 0.5f, 0.1f);
    EXPECT_EQ(point.ring, 300);
  }
}

}  // namespace
}  // namespace gaussmap
