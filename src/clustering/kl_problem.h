// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gaussmap/clustering/kl_kmeans.h"

namespace gaussmap::detail {

/// Throws std::invalid_argument if an option is out of range. The message names the option.
void checkOptions(const KLKMeansOptions& options);

template <int D>
inline constexpr int kKLFeatures = 1 + D + D*(D + 1) / 2;

/// The nearest cluster centre of every input Gaussian. It is kept from one round to the next: if the centre of a
/// Gaussian has not moved, only a centre that has moved can be nearer.
template <int D>
struct KLAssignment {
  Eigen::Matrix<double, kKLFeatures<D>, Eigen::Dynamic> centres;  // y_w of each centre
  std::vector<double> distances;                                  // x_z . y_w of the nearest centre
  std::vector<int> labels;
};

/// A partition while k-means works on it. Means are relative to the centre of the problem.
template <int D>
struct KLPartition {
  std::vector<Gaussian<D>> centres;
  std::vector<int> labels;
  KLAssignment<D> assignment;  // the last assignment; its centres can be older
  std::vector<int> counts;     // members per cluster
  double distortion = 0.0;
  int iterations = 0;
  bool converged = true;
};

/// The input Gaussians, prepared for many runs of k-means: checked, centred and converted to features. With
/// x_z = [1, mu, upper triangle of Sigma + mu mu'] the divergence, eq. (8), is linear in x_z:
///   KL(z || w) = x_z . y_w - (ln |Sigma_z| + D) / 2,   P = Sigma_w^-1,
///   y_w = [(mu_w' P mu_w + ln |Sigma_w|) / 2, -P mu_w, P_ii / 2 and P_ij].
/// All distances of an assignment are therefore one matrix product. The input is centred about its weighted mean,
/// because far from the origin mu mu' would be so large that Sigma loses its digits.
template <int D>
class KLProblem {
 public:
  static constexpr int kFeatures = kKLFeatures<D>;
  using Features = Eigen::Matrix<double, Eigen::Dynamic, kFeatures>;  // n x F, one column per feature
  using Centres = decltype(KLAssignment<D>::centres);                 // F x k

  /// Keeps a C++ reference to `data`. Throws like KLKMeans.
  explicit KLProblem(const std::vector<Gaussian<D>>& data);

  std::size_t size() const { return data_.size(); }
  const Vector<D>& centre() const { return centre_; }
  const Eigen::VectorXd& weights() const { return weights_; }
  /// Returns input Gaussian j with its mean relative to the centre.
  Gaussian<D> input(std::size_t j) const { return {data_[j].mean - centre_, data_[j].cov, data_[j].weight}; }

  /// Finds the nearest of these cluster centres (means relative to the centre of the problem). Ties go to the smaller
  /// label. `assignment` can hold any earlier assignment of the same problem. This saves time and does not change the
  /// result.
  void assign(const std::vector<Gaussian<D>>& centres, KLAssignment<D>& assignment) const;
  /// Returns the distance, eq. (8), of every input Gaussian to the centre of its cluster.
  Eigen::VectorXd ownDistances(const KLPartition<D>& partition) const;
  /// Returns KL(u || v) of all pairs of cluster centres, k x k.
  static Eigen::MatrixXd distancesBetween(const std::vector<Gaussian<D>>& centres);

  /// Runs k-means from these cluster centres (means relative to the centre of the problem). It is faster if few of them
  /// differ from those of `earlier`.
  KLPartition<D> run(std::vector<Gaussian<D>> centres, const KLKMeansOptions& options,
                     KLAssignment<D> earlier = {}) const;
  /// Returns the partition with one cluster.
  KLPartition<D> oneCluster() const;
  /// Returns the clustering in which each input Gaussian is its own cluster.
  KLClustering<D> eachItsOwn() const;
  /// Returns the partition in the frame of the input. merge() computes the centres, so they are bit-identical to the
  /// moment matches of their members.
  KLClustering<D> finish(const KLPartition<D>& partition) const;

 private:
  void assignAll(KLAssignment<D>& assignment) const;
  void assignAgain(KLAssignment<D>& assignment, const std::vector<char>& changed) const;
  /// Computes the cluster centres from the labels, eqs. (9), (10). Drops empty clusters and renumbers the labels. Then
  /// computes the distortion, eq. (7).
  void update(KLPartition<D>& partition) const;

  const std::vector<Gaussian<D>>& data_;
  Vector<D> centre_ = Vector<D>::Zero();
  Features features_;
  Eigen::VectorXd weights_;    // alpha
  Eigen::VectorXd constants_;  // -(ln |Sigma_z| + D) / 2
  double weighted_log_determinants_ = 0.0;
};

}  // namespace gaussmap::detail
