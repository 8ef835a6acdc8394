// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The cost of replacing two clusters by their moment match, Yguel 2009 eqs. (9), (10). S_1 and S_2 are the covariances
/// of the two clusters, S_12 is the covariance of the moment match.
enum class MergeCost {
  /// `sqrt(det S_12) - sqrt(det S_1) - sqrt(det S_2)` [m^D]: the volume that the merge adds to the ellipsoids, up to a
  /// constant factor. The cost is negative for two clusters at the same place, because one ellipsoid replaces two.
  Volume,
  /// `((w_1 + w_2) ln det S_12 - w_1 ln det S_1 - w_2 ln det S_2) / 2` [nat], with w = weights. This is an upper bound
  /// of the log-likelihood that the merge loses (Runnalls 2007). With this cost, the moment match is weighted by
  /// the weights of the Gaussians. With Volume, it is weighted by the areas given to agglomerate().
  Runnalls,
  /// `min(KL(g_1 || g_2), KL(g_2 || g_1))` [nat], eq. (8), as in the paper, sec. 5.4. g_1 and g_2 are the two clusters.
  /// The divergence is not symmetric. The paper takes the minimum over all ordered pairs (Algorithm 2, line 14), so the
  /// cost of a pair is the smaller one of the two directions. The moment match is weighted by the weights of the
  /// Gaussians.
  KL
};

/// Options of agglomerate().
struct AgglomerateOptions {
  MergeCost cost = MergeCost::Volume;  ///< which pair is merged next
  std::size_t max_exact = 1000;        ///< with at most this number of input Gaussians, every pair is a candidate
  /// Number of neighbours of a cluster, >= 1. The neighbours are the clusters with the nearest means. With more than
  /// max_exact input Gaussians, two clusters are a candidate pair only if one is a neighbour of the other. A merged
  /// cluster inherits the neighbours of its two parts.
  std::size_t neighbours = 8;
  std::size_t restricted_until = 500;  ///< when this number of clusters is left, every pair becomes a candidate, >= 1
};

/// The sequence of merges that turns n Gaussians into one cluster. Node j < n is input Gaussian j. Node n + t is the
/// union that merge t made.
struct Dendrogram {
  /// One merge of two nodes.
  struct Merge {
    std::uint32_t first = 0;   ///< the node whose smallest input index is lower
    std::uint32_t second = 0;  ///< the other node
    double cost = 0.0;         ///< see MergeCost; costs do not always increase from merge to merge
  };
  std::size_t size = 0;       ///< number n of input Gaussians
  std::vector<Merge> merges;  ///< n - 1 merges in the order they were made; empty if n = 0
};

/// Clusters Gaussians bottom-up: merges the pair of smallest cost again and again, until one cluster is left.
///
/// The moment matching of MergeCost::Volume is weighted by `areas`: the surface that each Gaussian represents, in
/// any unit. The density of the sensor's points therefore has no influence on the clusters.
///
/// The clusters are ordered by their smallest input index. If several pairs have the smallest cost, the pair whose
/// first cluster is earliest is merged. If several of these have the same first cluster, the second cluster decides in
/// the same way. If no two costs are equal, the order of the input does not affect the clusters. The function is
/// single-threaded. If every pair is a candidate, it computes about 1.5 n^2 costs.
///
/// The means must be finite, the covariances positive definite, weights and areas positive and below 1e100, and n below
/// 2^31. There must be one area per Gaussian. Throws std::domain_error for a covariance and std::invalid_argument for
/// everything else; the message gives the index of the Gaussian or the name of the option.
template <int D>
GAUSSMAP_API Dendrogram agglomerate(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas,
                                    const AgglomerateOptions& options = {});

/// Returns the partition into k clusters: the state before the last k - 1 merges.
///
/// The result holds one label in [0, k) per input Gaussian. The clusters are numbered by their smallest input index, so
/// input Gaussian 0 has label 0. The partitions of one dendrogram are nested. For n = 0 the result is empty for any k.
/// Throws std::invalid_argument unless 1 <= k <= n.
GAUSSMAP_API std::vector<int> labels(const Dendrogram& dendrogram, std::size_t k);

}  // namespace gaussmap
