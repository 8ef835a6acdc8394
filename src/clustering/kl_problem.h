// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gaussmap/clustering/kl_kmeans.h"

namespace gaussmap::detail {

/// Throws std::invalid_argument, naming the option.
void checkOptions(const KLKMeansOptions& options);

template <int D>
inline constexpr int kKLFeatures = 1 + D + D*(D + 1) / 2;

/// The nearest reference of every datum. Kept from one round to the next: where a datum's reference has not moved,
/// only those that have can be nearer.
template <int D>
struct KLAssignment {
  Eigen::Matrix<double, kKLFeatures<D>, Eigen::Dynamic> references;  // y_w of each
  std::vector<double> distances;                                     // x_z . y_w of the nearest
  std::vector<int> labels;
};

/// A partition while k-means works on it: means about the centre of the problem.
template <int D>
struct KLPartition {
  std::vector<Gaussian<D>> references;
  std::vector<int> labels;
  KLAssignment<D> assignment;  // the last one made; its references may be older
  std::vector<int> counts;     // members per reference
  double distortion = 0.0;
  int iterations = 0;
  bool converged = true;
};

/// Data prepared for many runs of k-means: checked, centred, turned into features. With
/// x_z = [1, mu, upper triangle of Sigma + mu mu'] the divergence [8] is linear in x_z:
///   KL(z || w) = x_z . y_w - (ln |Sigma_z| + D) / 2,   P = Sigma_w^-1,
///   y_w = [(mu_w' P mu_w + ln |Sigma_w|) / 2, -P mu_w, P_ii / 2 and P_ij].
/// So all distances of an assignment are one matrix product. The data are centred about their weighted mean:
/// mu mu' would otherwise swallow Sigma far from the origin.
template <int D>
class KLProblem {
 public:
  static constexpr int kFeatures = kKLFeatures<D>;
  using Features = Eigen::Matrix<double, Eigen::Dynamic, kFeatures>;  // n x F, a column per feature
  using References = decltype(KLAssignment<D>::references);           // F x k

  /// Keeps a reference to `data`. Throws as KLKMeans says.
  explicit KLProblem(const std::vector<Gaussian<D>>& data);

  std::size_t size() const { return data_.size(); }
  const Vector<D>& centre() const { return centre_; }
  const Eigen::VectorXd& weights() const { return weights_; }
  /// Datum j with its mean about the centre.
  Gaussian<D> datum(std::size_t j) const { return {data_[j].mean - centre_, data_[j].cov, data_[j].weight}; }

  /// The nearest references (means about the centre); ties go to the smaller label. Any earlier assignment of the same
  /// problem makes it faster, and changes nothing.
  void assign(const std::vector<Gaussian<D>>& references, KLAssignment<D>& assignment) const;
  /// Distance [8] of every datum to the reference it is labelled with.
  Eigen::VectorXd ownDistances(const KLPartition<D>& partition) const;
  /// All KL(u || v) of a set of references, k x k.
  static Eigen::MatrixXd distancesBetween(const std::vector<Gaussian<D>>& references);

  /// K-means from references (means about the centre), the fewer of them differ from those of `earlier` the faster.
  KLPartition<D> run(std::vector<Gaussian<D>> references, const KLKMeansOptions& options,
                     KLAssignment<D> earlier = {}) const;
  /// The partition with all data in one cluster.
  KLPartition<D> oneCluster() const;
  /// Each datum its own cluster.
  KLClustering<D> eachItsOwn() const;
  /// The partition in the frame of the data, the references matched to their members to the last bit by merge().
  KLClustering<D> finish(const KLPartition<D>& partition) const;

 private:
  void assignAll(KLAssignment<D>& assignment) const;
  void assignAgain(KLAssignment<D>& assignment, const std::vector<char>& changed) const;
  /// References by [9], [10] from the labels; empty ones dropped, labels renumbered; distortion [7].
  void update(KLPartition<D>& partition) const;

  const std::vector<Gaussian<D>>& data_;
  Vector<D> centre_ = Vector<D>::Zero();
  Features features_;
  Eigen::VectorXd weights_;    // alpha
  Eigen::VectorXd constants_;  // -(ln |Sigma_z| + D) / 2
  double weighted_log_determinants_ = 0.0;
};

}  // namespace gaussmap::detail
