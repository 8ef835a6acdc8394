// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The cost of replacing two clusters by their moment match with covariance S_12, Yguel 2009 eqs. (9), (10).
/// The cost can be negative: two clusters at the same place need only one ellipsoid.
enum class MergeCost {
  /// `sqrt(det S_12) - sqrt(det S_1) - sqrt(det S_2)` [m^D]: the space that the merged cluster covers and that no
  /// point supports.
  Volume,
  /// `((w_1 + w_2) ln det S_12 - w_1 ln det S_1 - w_2 ln det S_2) / 2` [nat], w = weights: an upper bound of the
  /// likelihood that the merge loses (Runnalls 2007). The moment match then uses the weights instead of the areas.
  Runnalls
};

/// Options of agglomerate().
struct AgglomerateOptions {
  MergeCost cost = MergeCost::Volume;  ///< which pair is merged next
  std::size_t max_exact = 1000;        ///< with at most this number of input Gaussians, every pair is a candidate
  /// Number of nearest neighbours of a cluster (by their means), >= 1. With more than max_exact input Gaussians, a pair
  /// is a candidate only if one of its clusters is among these neighbours of the other.
  std::size_t neighbours = 8;
  std::size_t restricted_until = 500;  ///< with this number of clusters left, every pair is a candidate again, >= 1
};

/// The sequence of merges that turns n Gaussians into one cluster. Node j < n is input Gaussian j. Node n + t is the
/// union that merge t made.
struct Dendrogram {
  /// One merge of two nodes.
  struct Merge {
    std::uint32_t first = 0;   ///< the node that holds the smallest input index of the two
    std::uint32_t second = 0;  ///< the other node
    double cost = 0.0;         ///< see MergeCost; costs do not always increase from merge to merge
  };
  std::size_t size = 0;       ///< n
  std::vector<Merge> merges;  ///< n - 1 merges in the order they were made; empty if n = 0
};

/// Clusters Gaussians bottom-up: merges the pair of smallest cost again and again, until one cluster is left.
///
/// The moment matching of MergeCost::Volume is weighted by `areas`: the surface that each Gaussian represents, in
/// any unit. The density of the sensor's points therefore has no influence on the clusters.
///
/// Clusters are ordered by their smallest input index. Of pairs with equal cost, the pair with the smaller first
/// cluster is merged, then the pair with the smaller second cluster. Input without ties gives the same clusters in any
/// order. The function is single-threaded and evaluates about 1.5 n^2 costs in vector registers.
///
/// The means must be finite, the covariances positive definite, weights and areas positive and below 1e100, and n below
/// 2^31. There must be one area per Gaussian. Throws std::domain_error for a covariance and std::invalid_argument for
/// everything else; the message gives the index of the Gaussian or the name of the option.
template <int D>
GAUSSMAP_API Dendrogram agglomerate(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas,
                                    const AgglomerateOptions& options = {});

/// Returns the partition into k clusters: the state before the last k - 1 merges.
///
/// The result holds n labels in [0, k), in the order of the smallest input index of each cluster. The partitions of one
/// dendrogram are nested. For n = 0 the result is empty for any k. Throws std::invalid_argument unless 1 <= k <= n.
GAUSSMAP_API std::vector<int> labels(const Dendrogram& dendrogram, std::size_t k);

}  // namespace gaussmap
