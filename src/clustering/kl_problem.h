// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "centre_distances.h"
#include "gaussmap/clustering/kl_kmeans.h"

namespace gaussmap::detail {

/// Throws std::invalid_argument if an option is out of range. The message names the option.
void checkOptions(const KLKMeansOptions& options);

/// Clusters and their members. Means are relative to the centre of the problem.
template <int D>
struct KLClusters {
  std::vector<Gaussian<D>> centres;
  std::vector<int> labels;
  std::vector<int> counts;  // members per cluster
  double distortion = 0.0;
};

/// A partition while k-means works on it.
template <int D>
struct KLPartition : KLClusters<D> {
  CentreAssignment assignment;  // the last assignment; its centres can be older
  int iterations = 0;
  bool converged = true;
};

/// The input Gaussians, prepared for many runs of k-means: checked and centred about their weighted mean. Far from the
/// origin, mu mu' would be so large that Sigma loses its digits.
template <int D>
class KLProblem {
 public:
  /// Keeps a C++ reference to `data`. Throws like KLKMeans.
  explicit KLProblem(const std::vector<Gaussian<D>>& data, GaussianDistance distance = GaussianDistance::KL);

  std::size_t size() const { return data_.size(); }
  const Vector<D>& centre() const { return centre_; }
  const Eigen::VectorXd& weights() const { return weights_; }
  /// Returns input Gaussian j with its mean relative to the centre.
  Gaussian<D> input(std::size_t j) const { return {data_[j].mean - centre_, data_[j].cov, data_[j].weight}; }
  /// True if no centre has a smaller distortion than the moment match of its members: the distortion never rises.
  bool momentMatchIsBest() const { return distance_ == GaussianDistance::KL; }

  // Of cluster centres with means relative to the centre of the problem; see CentreDistances.
  void assign(const std::vector<Gaussian<D>>& centres, CentreAssignment& assignment) const {
    distances_->assign(centres, assignment);
  }
  Eigen::VectorXd ownDistances(const KLClusters<D>& clusters) const {
    return distances_->toOwn(clusters.centres, clusters.labels);
  }
  Eigen::MatrixXd distancesBetween(const std::vector<Gaussian<D>>& centres) const {
    return distances_->between(centres);
  }

  /// Runs k-means from these cluster centres (means relative to the centre of the problem). It is faster if few of them
  /// differ from those of `earlier`.
  KLPartition<D> run(std::vector<Gaussian<D>> centres, const KLKMeansOptions& options,
                     CentreAssignment earlier = {}) const;
  /// Returns the moment matches of the clusters of these labels, eqs. (9), (10), and their distortion, eq. (7). Labels
  /// are smaller than `k`. Empty clusters are dropped, and the labels are then renumbered.
  KLClusters<D> clustersOf(std::vector<int> labels, std::size_t k) const;
  /// Returns the partition with one cluster.
  KLPartition<D> oneCluster() const;
  /// Returns the clustering in which each input Gaussian is its own cluster.
  KLClustering<D> eachItsOwn() const;
  /// Returns the partition in the frame of the input. merge() computes the centres, so they are bit-identical to the
  /// moment matches of their members.
  KLClustering<D> finish(const KLPartition<D>& partition) const;

 private:
  double distortionOf(const KLClusters<D>& clusters) const;

  const std::vector<Gaussian<D>>& data_;
  GaussianDistance distance_;
  std::unique_ptr<CentreDistances<D>> distances_;
  Vector<D> centre_ = Vector<D>::Zero();
  Eigen::VectorXd weights_;  // alpha
  double weighted_log_determinants_ = 0.0;
};

}  // namespace gaussmap::detail
