// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/kl_kmeans.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "gaussmap/pcl/conversions.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

pcl::PointCloud<PointGaussian>::Ptr finest() {
  return toPointCloud(build<3>(test::randomCloud<3>(2000, 12), {0.5, 10, 2, 0.0}), 0).makeShared();
}

TEST(PointCloudKLKMeans, GivesTheClustersOfTheCore) {
  const auto cloud = finest();
  std::vector<Gaussian<3>> data;
  for (const PointGaussian& point : *cloud) {
    Gaussian<3> gaussian;
    const auto& c = point.covariance;
    gaussian.mean = point.getVector3fMap().cast<double>();
    gaussian.cov << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
    gaussian.weight = double(point.weight);
    data.push_back(gaussian);
  }
  KLKMeansOptions options;
  options.k = 7;
  const KLClustering<3> expected = KLKMeans<3>(options).fit(data);
  PointCloudKLKMeans clustering;
  clustering.setNumberOfClusters(7);
  clustering.setInputCloud(cloud);
  std::vector<pcl::PointIndices> clusters;
  clustering.cluster(clusters);
  ASSERT_EQ(clusters.size(), expected.centres.size());
  EXPECT_EQ(clustering.result().distortion, expected.distortion);
  std::size_t members = 0;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    members += clusters[k].indices.size();
    for (const auto i : clusters[k].indices) EXPECT_EQ(expected.labels[std::size_t(i)], int(k));
    const PointGaussian& centre = clustering.getCentres()[k];
    EXPECT_LT((centre.getVector3fMap().cast<double>() - expected.centres[k].mean).norm(), 1e-5);
    EXPECT_NEAR(double(centre.covariance[1]), expected.centres[k].cov(0, 1), 1e-5);
    EXPECT_NEAR(double(centre.weight), expected.centres[k].weight, 1e-3);
    EXPECT_EQ(centre.cell_side, 0.5f);
    EXPECT_EQ(centre.occupancy, 10.0f);
  }
  EXPECT_EQ(members, cloud->size());
}

TEST(PointCloudKLKMeans, TakesTheDistanceOfTheOptions) {
  const auto cloud = finest();
  std::vector<std::vector<int>> labels;
  for (const GaussianDistance distance : {GaussianDistance::KL, GaussianDistance::SymmetricKL,
                                          GaussianDistance::Bhattacharyya, GaussianDistance::Wasserstein}) {
    KLKMeansOptions options;
    options.k = 7;
    options.distance = distance;
    PointCloudKLKMeans clustering(options);
    clustering.setInputCloud(cloud);
    std::vector<pcl::PointIndices> clusters;
    clustering.cluster(clusters);
    ASSERT_EQ(clusters.size(), clustering.result().centres.size());
    EXPECT_GT(clusters.size(), 4u);
    labels.push_back(clustering.result().labels);
    PointCloudKLKMeans later;
    later.setNumberOfClusters(7);
    later.setDistance(distance);
    later.setInputCloud(cloud);
    later.cluster(clusters);
    EXPECT_EQ(later.result().labels, labels.back());
  }
  // Two distances can give the same clusters of so few Gaussians, but not all of them.
  EXPECT_GE(std::set<std::vector<int>>(labels.begin(), labels.end()).size(), 3u);
}

TEST(PointCloudKLKMeans, ClustersChosenPointsAndLeavesOutThoseThatAreNone) {
  const auto cloud = finest();
  (*cloud)[4].x = std::numeric_limits<float>::quiet_NaN();
  const auto some = pcl::make_shared<pcl::Indices>();
  for (int i = 0; i < 40; i += 2) some->push_back(i);
  PointCloudKLKMeans clustering;
  clustering.setNumberOfClusters(3);
  clustering.setInputCloud(cloud);
  clustering.setIndices(some);
  std::vector<pcl::PointIndices> clusters;
  clustering.cluster(clusters);
  pcl::Indices all;
  for (const pcl::PointIndices& cluster : clusters)
    all.insert(all.end(), cluster.indices.begin(), cluster.indices.end());
  std::sort(all.begin(), all.end());
  some->erase(some->begin() + 2);
  EXPECT_EQ(all, *some);
}

TEST(PointCloudKLKMeans, GivesNothingForWhatItCannotCluster) {
  PointCloudKLKMeans clustering;
  std::vector<pcl::PointIndices> clusters(3);
  clustering.cluster(clusters);  // no cloud
  EXPECT_TRUE(clusters.empty());
  const auto cloud = finest();
  clustering.setInputCloud(cloud);
  clustering.setNumberOfClusters(0);
  clustering.cluster(clusters);
  EXPECT_TRUE(clusters.empty());
  clustering.setNumberOfClusters(2);
  (*cloud)[0].covariance[0] = -1.0f;
  clustering.cluster(clusters);
  EXPECT_TRUE(clusters.empty());
  clustering.setInputCloud(pcl::make_shared<pcl::PointCloud<PointGaussian>>());
  clustering.cluster(clusters);
  EXPECT_TRUE(clusters.empty());
}

}  // namespace
}  // namespace gaussmap
