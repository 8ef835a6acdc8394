// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The reference that Algorithm 2 puts at the datum of largest distortion (lines 5, 18, 21).
enum class ClusterSeed {
  ParentCovariance,  ///< the datum's mean with the covariance of the cluster that it leaves: takes its neighbours along
  Datum,             ///< the datum itself, as printed: its own small covariance repels every other datum
};

struct KLKMeansOptions {
  int k = 8;                ///< clusters asked for, >= 1
  int max_iterations = 50;  ///< of one run of k-means, >= 1
  double tolerance = 1e-6;  ///< a run stops when the distortion falls by less than this fraction, >= 0
  int max_swaps = 20;       ///< most rounds of the swap loop of Algorithm 2, >= 0 (0 = plain k-means)
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;
  std::uint64_t seed = 0;  ///< same input + same seed = same result
};

/// A partition of n Gaussians.
template <int D>
struct KLClustering {
  std::vector<Gaussian<D>> references;  ///< k' <= k, none empty; the moment match of its members each
  std::vector<int> labels;              ///< n, labels[i] in [0, k')
  double distortion = 0.0;              ///< sum_j alpha_j KL(z_j || w_label(j)) [nat], Yguel 2009 eq. (7)
  int iterations = 0;                   ///< of k-means, all runs together, rejected swaps too
  int swaps = 0;                        ///< accepted rounds of the swap loop
  bool converged = true;                ///< false: the run that gave this result stopped at max_iterations
};

/// Weighted k-means over Gaussians with the KL divergence as distance, Yguel 2009 sec. 5.2.1 after Davis & Dhillon
/// 2006: each datum goes to the nearest reference under [8] (ties to the smaller label), each reference becomes the
/// moment match [9], [10] of its members, until the labels stay or the distortion [7] hardly falls. A reference
/// that loses its last member is dropped. Single-threaded and deterministic.
///
/// Data: weights > 0 and finite, means finite, covariances positive definite; else std::invalid_argument (weight,
/// mean) or std::domain_error (covariance), naming the datum. No data give an empty result.
/// The assignment is one n x F by F x k product, F = 1 + D + D (D + 1) / 2; its rounding is about
/// 1e-16 (extent of the data / smallest standard deviation of a reference)^2 nat, wherever the data are.
template <int D>
class GAUSSMAP_API KLKMeans {
 public:
  /// Throws std::invalid_argument, naming the option.
  explicit KLKMeans(const KLKMeansOptions& options = {});

  /// Own start (drawn as in k-means++), then the swap loop of Algorithm 2. With k >= n each datum is its own cluster.
  KLClustering<D> fit(const std::vector<Gaussian<D>>& data) const;

  /// Plain k-means from given references, no swaps; `k` of the options is not used.
  /// Throws std::invalid_argument if there are data but no references, and as above for the references.
  KLClustering<D> run(const std::vector<Gaussian<D>>& data, const std::vector<Gaussian<D>>& initial_references) const;

 private:
  KLKMeansOptions options_;
};

/// One more cluster for a partition: Yguel 2009, Algorithm 2. K-means runs from the current references plus a seed at
/// the datum of largest distortion (ClusterSeed); then the swap loop takes a reference from where it is needed least
/// to the datum of largest distortion as long as that pays.
/// - `current_references` are the k - 1 clusters that there are; none = start with one cluster for all.
/// - The result has at most k clusters; no more than before if the data do not allow it (duplicates). Its distortion
///   never exceeds that of the current references. With k >= n each datum becomes its own cluster, distortion 0.
/// - options.k is not used. Data, references and errors as for KLKMeans.
template <int D>
GAUSSMAP_API KLClustering<D> insertCluster(const std::vector<Gaussian<D>>& data,
                                           const std::vector<Gaussian<D>>& current_references,
                                           const KLKMeansOptions& options = {});

}  // namespace gaussmap
