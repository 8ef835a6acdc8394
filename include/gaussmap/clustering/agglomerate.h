// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What it costs to replace two clusters by their moment match S_12, Yguel 2009 eqs. (9), (10). May be negative: two
/// clusters in the same place fill one ellipsoid instead of two.
enum class MergeCost {
  Volume,   ///< sqrt(det S_12) - sqrt(det S_1) - sqrt(det S_2): space that the map claims without having seen it
  Runnalls  ///< ((w_1 + w_2) ln det S_12 - w_1 ln det S_1 - w_2 ln det S_2) / 2, w = weights: bound of the likelihood
            ///< that is lost (Runnalls 2007); the moment match is by weight too, areas are not used
};

struct AgglomerateOptions {
  MergeCost cost = MergeCost::Volume;
  std::size_t max_exact = 1000;        ///< up to so many data every pair is a candidate
  std::size_t neighbours = 8;          ///< beyond, only pairs of so many nearest neighbours (by their means), >= 1 ...
  std::size_t restricted_until = 500;  ///< ... until so many clusters are left; then every pair again, >= 1
};

/// The history of merging n data into one cluster. Node j < n is datum j, node n + t the union that merge t made.
struct Dendrogram {
  struct Merge {
    std::uint32_t first = 0;   ///< node; it holds the smallest datum of the two
    std::uint32_t second = 0;  ///< node
    double cost = 0.0;         ///< [m^D] or [nat]; not always rising
  };
  std::size_t size = 0;       ///< n
  std::vector<Merge> merges;  ///< n - 1 in the order they were made (n = 0: none)
};

/// Bottom-up clustering: merges the pair of least cost, again and again, until one cluster is left. Moment matching
/// is weighted by `areas` (the surface that a datum stands for), so that the density of the sensor's points decides
/// nothing. Equal costs: the pair with the smaller first, then the smaller second cluster, where clusters are ordered
/// by their smallest datum; so data without ties give the same parts in any order. Single-threaded; about 1.5 n^2
/// costs, computed in vector registers.
/// Data: means finite, covariances positive definite, weights and areas > 0 and < 1e100, one area a datum; else
/// std::invalid_argument or std::domain_error (covariance), naming the datum. n < 2^31.
template <int D>
GAUSSMAP_API Dendrogram agglomerate(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas,
                                    const AgglomerateOptions& options = {});

/// The partition into k parts that stood before the last k - 1 merges: n labels in [0, k), ordered by the smallest
/// datum of each part. Partitions of one dendrogram are nested. Throws std::invalid_argument unless 1 <= k <= n;
/// no data have no labels, whatever k.
GAUSSMAP_API std::vector<int> labels(const Dendrogram& dendrogram, std::size_t k);

}  // namespace gaussmap
