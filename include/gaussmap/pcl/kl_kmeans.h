// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/impl/pcl_base.hpp>  // PointGaussian has no other

#include <vector>

#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/pcl/point_gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// KLKMeans for a cloud of Gaussians (toPointCloud()): setInputCloud(), setIndices() if only some count,
/// setNumberOfClusters(), cluster(). Points whose mean, covariance or weight is not finite are in no cluster.
/// What cannot be clustered (no cloud, no clusters, a covariance that is not positive definite) prints an error and
/// gives nothing.
class GAUSSMAP_API PointCloudKLKMeans : public pcl::PCLBase<PointGaussian> {
 public:
  explicit PointCloudKLKMeans(const KLKMeansOptions& options = {}) : options_(options) {}

  void setNumberOfClusters(int clusters) { options_.k = clusters; }
  void setSeed(std::uint64_t seed) { options_.seed = seed; }

  /// The clusters' points, none empty, at most as many as asked for; indices of the input cloud, rising.
  void cluster(std::vector<pcl::PointIndices>& clusters);

  /// Of the last cluster(): the Gaussian of each cluster, the moment match of its members. Scale, cell side and
  /// occupancy are the largest of them, the cell is that of its first member.
  const pcl::PointCloud<PointGaussian>& getReferences() const { return references_; }
  /// Of the last cluster(): its distortion, iterations and whether it converged.
  const KLClustering<3>& result() const { return result_; }

 private:
  KLKMeansOptions options_;
  pcl::PointCloud<PointGaussian> references_;
  KLClustering<3> result_;
};

}  // namespace gaussmap
