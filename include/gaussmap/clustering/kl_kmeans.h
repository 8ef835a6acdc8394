// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// How a new cluster centre is made, Yguel 2009, Algorithm 2, lines 5, 18 and 21. The centre is placed at the Gaussian
/// of largest distortion: the one with the largest distance from the centre of its cluster.
enum class ClusterSeed {
  /// The centre has the mean of this Gaussian and the covariance of the cluster that contains it. Neighbours of the
  /// Gaussian can then join the new cluster.
  ParentCovariance,
  /// The centre is a copy of this Gaussian, as in the paper. Its small covariance keeps all other Gaussians out of the
  /// new cluster.
  InputGaussian,
};

/// Options of KLKMeans and insertCluster().
struct KLKMeansOptions {
  int k = 8;                ///< number of clusters, >= 1
  int max_iterations = 50;  ///< maximum per run of k-means, >= 1
  double tolerance = 1e-6;  ///< a run stops when the distortion falls by less than this fraction, in [0, 1)
  int max_swaps = 20;       ///< maximum rounds of the swap loop of Algorithm 2, >= 0 (0 = plain k-means)
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;  ///< the new centre in the swap loop and in insertCluster()
  GaussianDistance distance = GaussianDistance::KL;       ///< from a Gaussian to a cluster centre; see KLKMeans
  std::uint64_t seed = 0;                                 ///< same input + same seed = bit-identical result
};

/// The result of k-means: a partition of n Gaussians.
template <int D>
struct KLClustering {
  std::vector<Gaussian<D>> centres;  ///< k' cluster centres, at most k; each is the moment match of its members
  std::vector<int> labels;           ///< per Gaussian: the index of its cluster centre, in [0, k')
  /// sum_j alpha_j d(z_j, w_label(j)), Yguel 2009 eq. (7), with the selected distance d [nat; Wasserstein: m^2]
  double distortion = 0.0;
  int iterations = 0;     ///< number of iterations of all k-means runs, including those of rejected swaps
  int swaps = 0;          ///< accepted rounds of the swap loop
  bool converged = true;  ///< false: the run that gave this result stopped at max_iterations
};

/// Weighted k-means over Gaussians, Yguel 2009 sec. 5.2.1 (after Davis & Dhillon 2006).
///
/// Each input Gaussian joins the nearest cluster centre. KLKMeansOptions::distance selects the distance from a Gaussian
/// to a centre, d_ZxF of Algorithm 2. The paper uses the KL divergence, eq. (8). Ties go to the smaller label. Each
/// centre then becomes the moment match of its members, eqs. (9), (10). The run ends when the labels stay the same or
/// the distortion, eq. (7), falls by less than the tolerance. A centre that loses its last member is dropped. The
/// algorithm is single-threaded and deterministic.
///
/// Only for the KL divergence, the moment match is the centre of minimum distortion. With another distance, the
/// distortion can increase in an iteration. The run then ends and returns the clusters of the previous iteration. The
/// distortion of the result is therefore never larger than that after the first assignment and moment match. The
/// initial centres of fit() do not depend on the distance.
///
/// Weights must be positive and finite, means finite, and covariances positive definite. The functions throw
/// std::invalid_argument for a weight or mean and std::domain_error for a covariance; the message gives the index of
/// the Gaussian. Empty input gives an empty result.
///
/// KL, SymmetricKL: the divergences between all n Gaussians and all k centres are computed as one matrix product. Their
/// rounding error is about 1e-16 (L / s)^2 nat, with L = extent of the input and s = smallest standard deviation of a
/// centre (SymmetricKL: or of the input). The distance of the input from the origin has no influence on this error.
/// Bhattacharyya, Wasserstein: each pair is evaluated, which takes several times as long.
template <int D>
class GAUSSMAP_API KLKMeans {
 public:
  /// Checks the options. Throws std::invalid_argument if an option is out of range; the message names the option.
  explicit KLKMeans(const KLKMeansOptions& options = {});

  /// Clusters `data` from random initial centres (drawn as in k-means++) and then runs the swap loop of Algorithm 2.
  /// If k >= n, each Gaussian is its own cluster.
  KLClustering<D> fit(const std::vector<Gaussian<D>>& data) const;

  /// Runs plain k-means on `data` from the given centres, without swaps. KLKMeansOptions::k is not used.
  /// Also throws std::invalid_argument if there is input but no initial centre. The centres must satisfy the same
  /// conditions as the input.
  KLClustering<D> run(const std::vector<Gaussian<D>>& data, const std::vector<Gaussian<D>>& initial_centres) const;

 private:
  KLKMeansOptions options_;
};

/// Adds one cluster to a partition, Yguel 2009, Algorithm 2.
///
/// K-means starts from the current centres and one new centre at the Gaussian of largest distortion (see ClusterSeed).
/// Then the swap loop begins. Each round moves one centre to the Gaussian of largest distortion and runs k-means again.
/// The moved centre is one of the two closest centres or a random one. The loop ends when a round does not reduce the
/// distortion, or after KLKMeansOptions::max_swaps rounds.
///
/// - `current_centres` are the k - 1 current cluster centres; this defines k. If there are none, the result is one
///   cluster.
/// - The result has at most k clusters. It can have fewer, for example if input Gaussians are equal.
/// - KL: the distortion of the result never exceeds that of the current centres.
/// - Other distances: each Gaussian joins the nearest current centre, and these k - 1 clusters are moment-matched. The
///   distortion of the result never exceeds that of these clusters. If a new cluster does not reduce it, these clusters
///   are the result.
/// - If k >= n, each Gaussian becomes its own cluster, with distortion 0.
///
/// KLKMeansOptions::k is not used. Input and errors are the same as for KLKMeans.
template <int D>
GAUSSMAP_API KLClustering<D> insertCluster(const std::vector<Gaussian<D>>& data,
                                           const std::vector<Gaussian<D>>& current_centres,
                                           const KLKMeansOptions& options = {});

}  // namespace gaussmap
