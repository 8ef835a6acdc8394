// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/impl/pcl_base.hpp>  // required for PointGaussian

#include <vector>

#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/pcl/point_gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Clusters a cloud of Gaussians (see toPointCloud()) with KLKMeans.
///
/// Call setInputCloud(), setIndices() to select some points, setNumberOfClusters() and cluster(). Points with a
/// non-finite mean, covariance or weight are in no cluster. If the input is not valid, cluster() prints an error
/// and gives no clusters: no cloud, a number of clusters below 1, a weight that is not positive, or a covariance that
/// is not positive definite.
class GAUSSMAP_API PointCloudKLKMeans : public pcl::PCLBase<PointGaussian> {
 public:
  /// Stores the options. They are checked by cluster().
  explicit PointCloudKLKMeans(const KLKMeansOptions& options = {}) : options_(options) {}

  /// Sets the number of clusters.
  void setNumberOfClusters(int clusters) { options_.k = clusters; }
  /// Sets the distance from a Gaussian to a cluster centre, see KLKMeans.
  void setDistance(GaussianDistance distance) { options_.distance = distance; }
  /// Sets the seed of the random numbers.
  void setSeed(std::uint64_t seed) { options_.seed = seed; }

  /// Computes the clusters. Each cluster is a list of indices of points in the input cloud, ascending. No cluster is
  /// empty. Their number is at most that of setNumberOfClusters().
  void cluster(std::vector<pcl::PointIndices>& clusters);

  /// Returns the Gaussian of each cluster of the last cluster(): the moment match of its members. Scale, cell side and
  /// occupancy are the maximum over the members. The cell is that of the first member.
  const pcl::PointCloud<PointGaussian>& getCentres() const { return centres_; }
  /// Returns the full result of the last cluster(): distortion, iterations, and whether it converged.
  const KLClustering<3>& result() const { return result_; }

 private:
  KLKMeansOptions options_;
  pcl::PointCloud<PointGaussian> centres_;
  KLClustering<3> result_;
};

}  // namespace gaussmap
